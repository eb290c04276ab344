// What takes the place of the readers of scans by ITK in a build without it.
#include "engine/volume/scan_reader.h"

namespace freevoxels {

namespace {

[[noreturn]] void refuseWithoutItk(const std::filesystem::path& file) {
  fail(ErrorKind::Input,
       "'{}' is a scan, and this FreeVoxels was built without their readers: build it with FREEVOXELS_SCANS, or convert "
       "the scan to .vdb or .raw",
       file.string());
}

}  // namespace

std::unique_ptr<ScanReader> openItkScan(const std::filesystem::path& file, ItkFormat) {
  refuseWithoutItk(file);
}

std::unique_ptr<ScanReader> openDicomScan(const std::filesystem::path& file, const std::optional<std::string>&) {
  refuseWithoutItk(file);
}

}  // namespace freevoxels
