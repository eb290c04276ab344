#include "apps/common/convert.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>
#include <system_error>
#include <vector>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/core/machine.h"
#include "engine/volume/scan_write.h"
#include "engine/volume/vdb.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

enum class Target { Vdb, Nrrd, Nifti };

Target targetOf(const std::string& file) {
  if (file.ends_with(".vdb")) return Target::Vdb;
  if (file.ends_with(".nrrd")) return Target::Nrrd;
  if (file.ends_with(".nii") || file.ends_with(".nii.gz")) return Target::Nifti;
  fail(ErrorKind::Usage, "'{}' is of no format that is written: name it .vdb, .nrrd, .nii or .nii.gz", file);
}

Volume readValues(const InputDescription& input, const Progress& progress) {
  Volume volume = input.open(machineMemoryBytes() / sizeof(float), {}, 0, progress);
  if (volume.classificationIsFixed)
    fail(ErrorKind::Input, "'{}' was baked for one classification, and has no values: convert what it was baked from, or bake that with {}",
         input.volume, Parameter("keep-scalars"));
  return volume;
}

/// The channels of a scan that are read one by one; none where there is one, or one is chosen.
std::vector<ScanChannel> channelsOf(const InputDescription& input) {
  if (input.kind() != VolumeKind::Scan || input.grid) return {};
  return readScanHeader(input.volume, input.scanRequest(std::numeric_limits<std::uint64_t>::max())).channels;
}

void convertChannels(const InputDescription& input, const std::vector<ScanChannel>& channels, const std::string& file,
                     const ConvertRemarks& remarks, const Progress& progress) {
  if (targetOf(file) != Target::Vdb)
    fail(ErrorKind::Usage, "'{}' has {} channels, and '{}' takes one: choose it with {}, or write .vdb, which takes all", input.volume,
         channels.size(), file, Parameter("grid", "NAME"));
  std::vector<Volume> volumes;
  std::vector<NamedScalars> grids;
  std::set<std::string> names;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    InputDescription one = input;
    one.grid = fmt::format("{}", i);
    volumes.push_back(readValues(one, progress));
    if (remarks) remarks(volumes.back());
    std::string name = channels[i].name.empty() ? fmt::format("channel{}", i) : channels[i].name;
    if (!names.insert(name).second) name += fmt::format(" {}", i);
    grids.push_back({.name = std::move(name), .volume = nullptr});
  }
  for (std::size_t i = 0; i < grids.size(); ++i) grids[i].volume = &volumes[i];
  if (progress) progress("writing the file", 0.0);
  writeVdb(file, grids);
}

}  // namespace

void checkConvert(const InputDescription& input, const std::string& file) {
  targetOf(file);
  input.check();
  std::error_code error;
  if (!proceduralName(input.volume) && fs::equivalent(input.volume, file, error))
    fail(ErrorKind::Usage, "'{}' would be replaced by what is read of it: name another file to write", file);
  checkWritable(file);
}

void convertVolume(const InputDescription& input, const std::string& file, const ConvertRemarks& remarks, const Progress& progress) {
  if (const std::vector<ScanChannel> channels = channelsOf(input); channels.size() > 1)
    return convertChannels(input, channels, file, remarks, progress);
  const Volume volume = readValues(input, progress);
  if (remarks) remarks(volume);
  switch (targetOf(file)) {
    case Target::Vdb:
      if (progress) progress("writing the file", 0.0);
      return writeVdb(file, {{.name = input.kind() == VolumeKind::OpenVdb && input.grid ? *input.grid : "density", .volume = &volume}});
    case Target::Nrrd:
      return writeNrrd(file, volume, progress);
    case Target::Nifti:
      return writeNifti(file, volume, progress);
  }
}

}  // namespace freevoxels
