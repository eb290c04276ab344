// What takes the place of the readers of scans that are not ITK's in a build without them (FREEVOXELS_SCANS).
#include "engine/volume/scan_reader.h"

namespace freevoxels {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& file) {
  fail(ErrorKind::Input,
       "'{}' is a scan, and this FreeVoxels was built without their readers: build it with FREEVOXELS_SCANS, or convert "
       "the scan to .vdb or .raw",
       file.string());
}

}  // namespace

std::unique_ptr<ScanReader> openNgffScan(const std::filesystem::path& file, const ScanRequest&) {
  refuse(file);
}

std::unique_ptr<ScanReader> openTiffScan(const std::filesystem::path& file) {
  refuse(file);
}

std::unique_ptr<ScanReader> openVtiScan(const std::filesystem::path& file, const std::string&) {
  refuse(file);
}

}  // namespace freevoxels
