#include "engine/volume/vdb_grid_reader.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>

#include <algorithm>

namespace freevoxels {

namespace {

/// Gives access to what OpenVDB's own readers of files and streams are made of.
class GridArchive : public openvdb::io::Archive {
 public:
  explicit GridArchive(std::istream& input) {
    readHeader(input);
    openvdb::io::setStreamMetadataPtr(input, metadata_, false);
    openvdb::io::setVersion(input, libraryVersion(), fileVersion());
    openvdb::io::setDataCompression(input, compression());
  }
  static void read(const openvdb::GridBase::Ptr& grid, const openvdb::io::GridDescriptor& descriptor, std::istream& input) {
    readGrid(grid, descriptor, input);
  }

 private:
  openvdb::io::StreamMetadata::Ptr metadata_{new openvdb::io::StreamMetadata};
};

}  // namespace

ReportingFile::ReportingFile(const std::filesystem::path& file, std::uint64_t expected, const Progress& progress)
    : std::istream(&buffer_), buffer_(expected, progress) {
  exceptions(std::ios::failbit | std::ios::badbit);
  if (buffer_.open(file, std::ios::in | std::ios::binary) == nullptr) setstate(std::ios::failbit);
}

ReportingFile::Buffer::int_type ReportingFile::Buffer::underflow() {
  const int_type character = std::filebuf::underflow();
  count(egptr() - gptr());
  return character;
}

std::streamsize ReportingFile::Buffer::xsgetn(char* to, std::streamsize bytes) {
  const std::streamsize read = std::filebuf::xsgetn(to, bytes);
  count(read);
  return read;
}

/// What is read through the buffer is counted when the buffer is filled, too: the fraction is an estimate.
void ReportingFile::Buffer::count(std::streamsize bytes) {
  constexpr std::uint64_t kInterval = 4 << 20;
  read_ += std::uint64_t(bytes);
  if (!progress_ || read_ < next_) return;
  next_ = read_ + kInterval;
  progress_("reading the grid", std::min(double(read_) / double(std::max<std::uint64_t>(expected_, 1)), 1.0));
}

openvdb::GridBase::Ptr readVdbGrid(const std::filesystem::path& file, const VdbHeader::Grid& entry, const Progress& progress) {
  ReportingFile input(file, entry.end - entry.start, progress);
  const GridArchive archive(input);
  openvdb::io::GridDescriptor descriptor(entry.uniqueName, entry.type, entry.savedAsHalf);
  openvdb::GridBase::Ptr grid = openvdb::GridBase::createGrid(entry.type);
  if (entry.savedAsHalf) grid->setSaveFloatAsHalf(true);
  input.seekg(std::streamoff(entry.start));
  GridArchive::read(grid, descriptor, input);
  return grid;
}

}  // namespace freevoxels
