#pragma once
// Internal to the vdb_*.cpp files, since it includes OpenVDB: reads files in a way that can be abandoned, which openvdb::io::File cannot.

#include <openvdb/Grid.h>

#include <filesystem>
#include <fstream>
#include <istream>

#include "engine/core/stages.h"
#include "engine/volume/vdb_header.h"

namespace freevoxels {

/// A file that calls `progress`, which must outlive it, at every few MiB that are read; an empty one is not called. It throws what that
/// throws, and std::ios_base::failure where it cannot be read.
class ReportingFile : public std::istream {
 public:
  /// `expected` bytes will be read.
  ReportingFile(const std::filesystem::path& file, std::uint64_t expected, const Progress& progress);

 private:
  class Buffer : public std::filebuf {
   public:
    Buffer(std::uint64_t expected, const Progress& progress) : progress_(progress), expected_(expected) {}

   protected:
    int_type underflow() override;
    std::streamsize xsgetn(char* to, std::streamsize bytes) override;

   private:
    void count(std::streamsize bytes);

    const Progress& progress_;
    const std::uint64_t expected_;
    std::uint64_t read_ = 0, next_ = 0;
  };

  Buffer buffer_;
};

/// Reads a grid that has a tree of its own, with all values. Throws what ReportingFile and OpenVDB throw. OpenVDB must be initialised.
openvdb::GridBase::Ptr readVdbGrid(const std::filesystem::path& file, const VdbHeader::Grid& grid, const Progress& progress);

}  // namespace freevoxels
