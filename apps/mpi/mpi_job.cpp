#include "apps/mpi/mpi_job.h"

#include <fmt/format.h>
#include <sched.h>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <map>
#include <sstream>
#include <thread>

#include "apps/common/share_options.h"
#include "apps/common/text_table.h"
#include "apps/mpi/local_share.h"
#include "engine/core/error.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

namespace {

/// Integers of one piece of the sums: pieces are on their way at the same time, along the steps of the reduction.
constexpr std::size_t kValuesAtOnce = std::size_t(1) << 18;

/// Between two looks at the pieces. A thread that waits in MPI itself would take a processor from drawing.
constexpr std::chrono::microseconds kBetweenLooks{100};

/// The number of processes that the launcher's environment variables speak of, 1 where there are none.
int launchedProcesses() {
  // Open MPI's mpirun; MPICH's and Intel's launchers; srun.
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"})
    if (const char* text = std::getenv(name)) return std::max(std::atoi(text), 1);
  return 1;
}

/// The text of rank 0 of these processes, on all of them.
std::string broadcast(MPI_Comm processes, std::string text) {
  std::uint64_t length = text.size();
  MPI_Bcast(&length, 1, MPI_UINT64_T, 0, processes);
  text.resize(length);
  MPI_Bcast(text.data(), int(length), MPI_CHAR, 0, processes);
  return text;
}

/// The texts of all processes on rank 0, by rank; elsewhere empty.
std::vector<std::string> gather(const std::string& text, int rank, int size) {
  const int length = int(text.size());
  std::vector<int> lengths(std::size_t(size), 0), offsets(std::size_t(size), 0);
  MPI_Gather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
  for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] = offsets[i - 1] + lengths[i - 1];
  std::string all(std::size_t(offsets.back() + lengths.back()), '\0');
  MPI_Gatherv(text.data(), length, MPI_CHAR, all.data(), lengths.data(), offsets.data(), MPI_CHAR, 0, MPI_COMM_WORLD);
  std::vector<std::string> texts;
  if (rank == 0)
    for (std::size_t i = 0; i < lengths.size(); ++i) texts.push_back(all.substr(std::size_t(offsets[i]), std::size_t(lengths[i])));
  return texts;
}

std::string layoutText(const FixedSums& sums) {
  return fmt::format("{} {}x{} {}x{}+{}+{} {}", sums.lattice ? latticeText(*sums.lattice) : "pixels", sums.size.x, sums.size.y, sums.extent.x, sums.extent.y, sums.first.x, sums.first.y,
                     fmt::join(sums.digits, " "));
}

}  // namespace

MpiJob::MpiJob(int& argc, char**& argv) {
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &threads_);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &node_);
  MPI_Comm_rank(node_, &rankOnNode_);
  MPI_Comm_size(node_, &sizeOfNode_);
  splitFrames(size_);
  shareProcessors();
}

MpiJob::~MpiJob() {
  MPI_Comm_free(&frameGroup_);
  MPI_Comm_free(&node_);
  MPI_Finalize();
}

void MpiJob::shareProcessors() const {
  // Processes may be bound to processors of their own, to the same, or not at all.
  cpu_set_t own{}, all{};
  if (sched_getaffinity(0, sizeof(own), &own) != 0) return;
  MPI_Allreduce(&own, &all, int(sizeof(own)), MPI_BYTE, MPI_BOR, node_);
  const int threads = threadsOfRank(CPU_COUNT(&all), CPU_COUNT(&own), sizeOfNode_);
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 0);
  static tbb::global_control control(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
}

void MpiJob::begin() {
  const int launched = launchedProcesses();
  if (size_ == 1 && launched > 1)
    fail(ErrorKind::Usage,
         "{} processes were started, but each is alone: this program is built with Open MPI; start it with Open MPI's mpirun, or with "
         "srun --mpi=pmix",
         launched);
  if (threads_ < MPI_THREAD_SERIALIZED)
    fail(ErrorKind::Usage, "this MPI library lets only the main thread use it: start the job with one that has MPI_THREAD_SERIALIZED");
  checkRanks(size_);
}

void MpiJob::splitFrames(int ranksPerFrame) {
  if (ranksPerFrame > size_)
    fail(ErrorKind::Usage, "--ranks-per-frame {} is more than the job's {} ranks: choose a smaller number", ranksPerFrame, size_);
  groupCount_ = size_ / ranksPerFrame;
  // What is left over joins the last group.
  group_ = std::min(rank_ / ranksPerFrame, groupCount_ - 1);
  if (frameGroup_ != MPI_COMM_NULL) MPI_Comm_free(&frameGroup_);
  MPI_Comm_split(MPI_COMM_WORLD, group_, rank_, &frameGroup_);
  MPI_Comm_rank(frameGroup_, &rankInGroup_);
  MPI_Comm_size(frameGroup_, &sizeOfGroup_);
}

void MpiJob::abort(int exitCode) const {
  MPI_Abort(MPI_COMM_WORLD, exitCode);
  std::abort();
}

std::uint64_t MpiJob::least(std::uint64_t value) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_UINT64_T, MPI_MIN, MPI_COMM_WORLD);
  return value;
}

std::string MpiJob::name() const {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  return fmt::format("rank {} on {}", rank_, host.data());
}

std::string MpiJob::deviceSelector() const {
  const Instance instance(false);
  std::vector<std::string> gpus;
  for (const DeviceDescription& device : listDevices(instance))
    if (device.rejections.empty() && device.type.ends_with("GPU")) gpus.push_back(device.uuid);
  return gpuOfRank(gpus, rankOnNode_);
}

void MpiJob::agreeWithin(MPI_Comm processes, const std::string& what, const std::string& text) const {
  const int mine = broadcast(processes, text) == text ? size_ : rank_;
  int firstOther = size_;
  MPI_Allreduce(&mine, &firstOther, 1, MPI_INT, MPI_MIN, processes);
  if (firstOther == size_) return;
  // That rank reports it; the others wait until it has ended the job.
  if (firstOther != rank_) MPI_Barrier(processes);
  fail(ErrorKind::Input, "{} has {} than rank 0: give all ranks the same", name(), what);
}

bool MpiJob::addUp(FixedSums& sums) {
  agreeWithin(frameGroup_, "a device that needs another method", layoutText(sums) + " " + sums.method);
  std::vector<MPI_Request> pieces;
  pieces.reserve(sums.values.size() / kValuesAtOnce + 1);  // their places must not change
  for (std::size_t first = 0; first < sums.values.size(); first += kValuesAtOnce) {
    const int count = int(std::min(kValuesAtOnce, sums.values.size() - first));
    std::int64_t* values = sums.values.data() + first;
    MPI_Ireduce(rankInGroup_ == 0 ? MPI_IN_PLACE : values, values, count, MPI_INT64_T, MPI_SUM, 0, frameGroup_,
                &pieces.emplace_back(MPI_REQUEST_NULL));
  }
  const auto complete = [&] {
    int all = 0;
    MPI_Testall(int(pieces.size()), pieces.data(), &all, MPI_STATUSES_IGNORE);
    return all != 0;
  };
  while (!complete()) std::this_thread::sleep_for(kBetweenLooks);
  return rankInGroup_ == 0;
}

void MpiJob::bring(std::vector<std::byte>& bytes, int from) {
  std::uint64_t count = bytes.size();
  if (rank_ == from) {
    MPI_Send(&count, 1, MPI_UINT64_T, 0, 0, MPI_COMM_WORLD);
    MPI_Send(bytes.data(), int(count), MPI_BYTE, 0, 0, MPI_COMM_WORLD);
    return;
  }
  MPI_Recv(&count, 1, MPI_UINT64_T, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  bytes.resize(count);
  MPI_Recv(bytes.data(), int(count), MPI_BYTE, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

void MpiJob::logStages(const RunReport& report) {
  std::string mine;
  for (const StageTime& stage : report.stages) mine += fmt::format("{}\t{}\n", stage.name, stage.milliseconds);
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> times;
  for (const std::string& text : gather(mine, rank_, size_)) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const std::string name = line.substr(0, line.find('\t'));
      if (!times.contains(name)) names.push_back(name);
      times[name].push_back(std::stod(line.substr(name.size() + 1)));
    }
  }
  if (!leads()) return;
  using enum TextTable::Align;
  TextTable table{.columns = {Left, Right, Right, Right}, .rows = {{"stage, ms over the ranks", "least", "mean", "most"}}};
  for (const std::string& name : names) {
    std::vector<double>& ofRanks = times[name];
    ofRanks.resize(std::size_t(size_), 0.0);  // ranks without the stage took no time for it
    double sum = 0.0;
    for (const double time : ofRanks) sum += time;
    const auto [least, most] = std::ranges::minmax(ofRanks);
    table.rows.push_back(
        {name, fmt::format("{:.2f}", least), fmt::format("{:.2f}", sum / double(size_)), fmt::format("{:.2f}", most)});
  }
  for (const std::string& line : table.lines()) spdlog::debug("{}", line);
}

}  // namespace freevoxels
