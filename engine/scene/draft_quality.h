#pragma once
// The quality of drafts that are to be drawn within a time.

namespace freevoxels {

/// Chooses FrameSettings::quality from the times of the frames before, on the assumption that a frame's time follows the number of its
/// rays, the square of its quality.
class DraftQuality {
 public:
  static constexpr double kLeast = 0.05;

  /// `milliseconds`, more than 0, is the time that a frame may take; `least`, kLeast to 1, the quality that it has however long it takes.
  explicit DraftQuality(double milliseconds, double least = kLeast) : milliseconds_(milliseconds), least_(least) {}

  double milliseconds() const { return milliseconds_; }
  /// Of the next frame, in least..1.
  double quality() const { return quality_; }
  /// Begins anew from the time of a frame of a quality, which may be 1.
  void beginFrom(double frameMilliseconds, double quality);
  /// Reports the time of the last frame, which had quality(). Follows slowly, as one frame takes longer than the next for other reasons,
  /// too.
  void took(double frameMilliseconds);

 private:
  double milliseconds_, least_;
  double quality_ = 0.25;
};

}  // namespace freevoxels
