#pragma once
// How a frame that is divided among ranks scales: Subr et al. 2007, Figure 8.

#include <cstdint>
#include <string>
#include <vector>

#include "engine/validation/report.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// A network by the α–β model: a message of b bytes takes `latency` + b / `bandwidth` seconds.
struct Network {
  std::string name;
  double latency = 0.0;    ///< seconds
  double bandwidth = 0.0;  ///< bytes a second
};
/// 10 Gb/s with 20 µs, about Ethernet with TCP, and 100 Gb/s with 2 µs, about InfiniBand.
const std::vector<Network>& networks();

/// Seconds in which `ranks` ranks add up `bytes` by reduce-scatter and gather (Rabenseifner 2004), without the additions.
double reductionSeconds(const Network& network, int ranks, std::uint64_t bytes);

struct Scaling {
  struct Ranks {
    int count = 1;
    double slowest = 0.0, mean = 0.0;      ///< milliseconds to draw a rank's shares
    std::vector<double> speedUps;          ///< by network; 1 for one rank
  };
  std::string volume;         ///< "opaque head 512^3"
  std::uint64_t blocks = 0;   ///< drawn
  std::uint64_t bytes = 0;    ///< that a rank sends of its sums
  double atOnce = 0.0;        ///< milliseconds of the same frame drawn at once, without shares
  std::uint64_t differentSums = 0;  ///< sums of eight ranks, added up, that differ in a bit from those of one rank
  std::vector<Ranks> ranks;
};

/// Draws what each of n = 1, 8, 16, 32, 64 and 128 ranks would draw by splats, one after the other on this device, at 1024 x 1024 pixels.
/// Volumes are made with `resolution`³ voxels: an opaque head, a fog (a cloud), and a box with a plume of smoke.
///
/// Times are the least of two runs. On a CPU device they are the processor time of this process, which other programs on the machine do
/// not lengthen: that of a rank with one thread, whatever the number of processors here. On a GPU they are wall times.
std::vector<Scaling> clusterScalings(const Device& device, int resolution);

/// The speed-ups as tables and as a plot with the ideal; what limits each volume most; and the check that the sums of eight ranks are
/// those of one to the bit.
ReportSection clusterSection(const std::vector<Scaling>& scalings);

}  // namespace freevoxels
