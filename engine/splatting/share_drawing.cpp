#include "engine/splatting/share_drawing.h"

#include <algorithm>

namespace freevoxels {

namespace {

/// Shares of one submission: few enough for a submission's timestamps and for progress to move.
constexpr std::size_t kSharesAtOnce = 16;

}  // namespace

FixedSums ShareDrawing::draw(Commands& commands, Inputs inputs, const SharePart& part, std::vector<StageTime>& times,
                             const Progress& progress) {
  list_.record(commands, inputs.drawing.volume, *inputs.drawing.visible, inputs.mostBlocks, inputs.wholeLevel);
  accumulate_.recordClear(commands, std::move(inputs.layout));
  commands.submitAndWait(progress);
  addTimes(times, commands.times());

  list_.select(part);
  inputs.drawing.visible = &list_.chunks();
  inputs.drawing.order = &list_.blocks();
  inputs.drawing.chunkCount = 0;
  const std::vector<std::uint32_t>& chunks = list_.chunksOfShares();
  for (std::size_t first = 0; first < chunks.size(); first += kSharesAtOnce) {
    Commands drawing(device_);
    inputs.drawing.onSplats = [&](const Buffer& splats, std::uint32_t chunk) {
      accumulate_.recordMarks(drawing, splats, list_.chunks(), chunk);
    };
    const std::size_t end = std::min(first + kSharesAtOnce, chunks.size());
    for (std::size_t share = first; share < end; ++share) {
      inputs.drawing.firstChunk += inputs.drawing.chunkCount;
      inputs.drawing.chunkCount = chunks[share];
      inputs.splats.record(drawing, inputs.drawing, inputs.frame, inputs.targets);
      accumulate_.record(drawing, inputs.frame, inputs.targets);
      inputs.drawing.continued = true;  // the targets are 0 again
    }
    drawing.submitAndWait();
    addTimes(times, drawing.times());
    if (progress) progress("drawing shares", double(end) / double(chunks.size()));
  }
  const StageTimer timer(times, "copy to host");
  return accumulate_.read();
}

}  // namespace freevoxels
