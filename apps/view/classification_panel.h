#pragma once
// The panel of the classification: density, or a transfer function.

#include <string>

#include "apps/view/async_value.h"
#include "apps/view/color_strip.h"
#include "apps/view/opacity_curve.h"
#include "apps/view/transfer_model.h"
#include "apps/view/view_state.h"
#include "apps/view/widgets.h"

namespace freevoxels {

/// Number of bins, so that a narrow window of values still has some.
inline constexpr int kHistogramBins = 2048;

class ClassificationPanel {
 public:
  void draw(ViewState& state);
  /// For the histogram.
  bool waits() const { return histogram_.isMaking(); }

 private:
  void follow(ViewState& state);
  /// Forgets the selected points and the preset of curves that no longer exist.
  void deselect();
  void drawKind(ViewState& state);
  void drawDensity(ViewState& state);
  void drawTransferFunction(ViewState& state);
  bool drawPresets(const Volume& volume);
  bool drawRange(const Volume& volume);
  bool drawFile(ViewState& state);

  AsyncValue<std::shared_ptr<const Volume>, Histogram> histogram_{
      [](const std::shared_ptr<const Volume>& volume) { return histogramOf(*volume, kHistogramBins); }};
  AutomaticSlider scale_, unitDistance_;
  OpacityCurve curve_;
  ColorStrip strip_;

  std::string volume_;             ///< source of the volume that the other members belong to
  ClassificationOptions density_;  ///< options before there was a transfer function
  TransferModel model_;
  std::string modelText_;  ///< text of the option that model_ was read from, or written to
  std::string file_, preset_;
};

}  // namespace freevoxels
