#include "engine/volume/vdb_grid_reader.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>

#include <algorithm>
#include <fstream>
#include <istream>
#include <utility>

namespace freevoxels {

namespace {

/// A file that reports how much of a stretch of it has been read.
class ReportingFile : public std::filebuf {
 public:
  ReportingFile(const std::filesystem::path& file, const Progress& progress) : progress_(progress) { open(file, std::ios::in | std::ios::binary); }
  void expect(double bytes) { expected_ = bytes; }

 protected:
  int_type underflow() override {
    const int_type character = std::filebuf::underflow();
    count(egptr() - gptr());
    return character;
  }
  std::streamsize xsgetn(char* to, std::streamsize bytes) override {
    const std::streamsize read = std::filebuf::xsgetn(to, bytes);
    count(read);
    return read;
  }

 private:
  static constexpr double kInterval = double(4 << 20);  // bytes

  void count(std::streamsize bytes) {
    read_ += double(bytes);
    if (read_ < next_) return;
    next_ = read_ + kInterval;
    progress_("reading the grid", std::min(read_ / expected_, 1.0));
  }

  const Progress& progress_;
  double read_ = 0.0, next_ = 0.0, expected_ = 1.0;
};

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

openvdb::GridBase::Ptr readVdbGrid(const std::filesystem::path& file, const VdbHeader::Grid& entry, const Progress& progress) {
  ReportingFile buffer(file, progress);
  buffer.expect(double(std::max<std::uint64_t>(entry.end - entry.start, 1)));
  std::istream input(buffer.is_open() ? &buffer : nullptr);
  input.exceptions(std::ios::failbit | std::ios::badbit);  // which also passes on what `progress` throws
  const GridArchive archive(input);
  openvdb::io::GridDescriptor descriptor(entry.uniqueName, entry.type, entry.savedAsHalf);
  openvdb::GridBase::Ptr grid = openvdb::GridBase::createGrid(entry.type);
  if (entry.savedAsHalf) grid->setSaveFloatAsHalf(true);
  input.seekg(std::streamoff(entry.start));
  GridArchive::read(grid, descriptor, input);
  return grid;
}

}  // namespace freevoxels
