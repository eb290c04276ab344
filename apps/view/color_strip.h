#pragma once
// The colours of a transfer function, with points that can be dragged.

#include <optional>

#include "apps/view/plot_span.h"
#include "apps/view/transfer_model.h"

namespace freevoxels {

class ColorStrip {
 public:
  /// True where the model was changed.
  bool draw(TransferModel& model);

 private:
  bool handle(TransferModel& model, const PlotSpan& span, float y);
  bool remove(TransferModel& model, std::size_t point);

  std::optional<std::size_t> selected_;
};

}  // namespace freevoxels
