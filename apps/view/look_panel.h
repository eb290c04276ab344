#pragma once
// The panel "Look": density or transfer function, and emission.

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "apps/view/async_value.h"
#include "apps/view/volume_panel.h"
#include "apps/view/transfer_editor.h"
#include "apps/view/transfer_model.h"
#include "apps/view/view_state.h"
#include "apps/view/widgets.h"
#include "engine/vulkan/texture.h"

namespace freevoxels {

/// Number of bins, so that a narrow window of values still has some.
inline constexpr int kHistogramBins = 2048;

/// Small images of the volume with the presets of transfer functions, drawn by another thread.
class PresetImages {
 public:
  static constexpr glm::ivec2 kSize{72, 54};

  explicit PresetImages(const Device& device);
  /// Abandons what is being drawn.
  ~PresetImages();
  PresetImages(const PresetImages&) = delete;
  PresetImages& operator=(const PresetImages&) = delete;

  /// The image of a preset by its index; null while it is drawn. `latest` is the image whose volume, camera and light they have.
  const Texture* of(std::size_t preset, const std::shared_ptr<const DrawnImage>& latest);

 private:
  std::vector<Image> draw(const DrawnImage& like) const;

  const Device& device_;
  std::atomic<bool> ends_ = false;
  std::shared_ptr<const DrawnImage> like_;
  std::vector<std::unique_ptr<Texture>> textures_;
  AsyncValue<std::shared_ptr<const DrawnImage>, std::vector<Image>> images_;
};

class ClassificationPanel {
 public:
  explicit ClassificationPanel(const Device& device) : presets_(device) {}

  /// Into the current Dear ImGui window.
  void draw(ViewState& state);
  /// Takes over what was changed elsewhere. Called in every frame, whether or not the panel is open.
  void follow(ViewState& state);
  /// Another file was opened, for which other values suit.
  void forgetScales() { scale_ = unitDistance_ = AutomaticSlider(); }
  /// For the histogram.
  bool waits() const { return histogram_.isMaking(); }

 private:
  /// Forgets the selected points and the preset of curves that no longer exist.
  void deselect();
  /// Takes the function of an option's text for model_.
  void read(const std::string& text, const Volume& volume);
  void drawKind(ViewState& state);
  void drawDensity(ViewState& state);
  void drawTransferFunction(ViewState& state);
  bool drawPresets(ViewState& state);
  void drawWindow(ViewState& state);
  void drawChanges(ViewState& state);
  bool drawFile(ViewState& state);

  AsyncValue<std::shared_ptr<const Volume>, Histogram> histogram_{
      [](const std::shared_ptr<const Volume>& volume) { return histogramOf(*volume, kHistogramBins); }};
  PresetImages presets_;
  AutomaticSlider scale_, unitDistance_;
  OpacityCurve curve_;
  ColorStrip strip_;

  std::string volume_;             ///< source of the volume that the other members belong to
  ClassificationDescription density_;  ///< options before there was a transfer function
  TransferModel model_;
  std::optional<double> ownUnit_;  ///< TransferModel::unitDistance as the function has it for this volume, before the user changes it
  std::string modelText_;  ///< text of the option that model_ was read from, or written to
  std::string file_, preset_;
  std::string overwritten_;  ///< the file of that name that Save may replace: written by it, or asked for twice
};

class EmissionPanel {
 public:
  void draw(ViewState& state, GridList& grids);

 private:
  bool drawOptions(ViewState& state, const std::vector<GridChoice>& grids);

  AutomaticSlider strength_, scale_{5.0};
};

class LookPanel {
 public:
  explicit LookPanel(const Device& device) : classification_(device) {}

  void draw(ViewState& state, GridList& grids);
  /// Whether something that it shows is still being computed.
  bool waits() const { return classification_.waits(); }

 private:
  std::string opened_;  ///< openedName() of what the panels were last drawn for
  ClassificationPanel classification_;
  EmissionPanel emission_;
};

}  // namespace freevoxels
