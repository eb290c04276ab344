#pragma once
// What all OpenEXR files of this project have in common: how they are written, and the options in their headers. For sources that use
// OpenEXR.

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>

#include <filesystem>

#include "engine/image/image.h"

namespace freevoxels {

/// Lets OpenEXR compress and decompress blocks of scan lines in parallel.
void useAllProcessors();

/// Adds metadata and matrices to a header.
void insertOptions(Imf::Header& header, const ExrOptions& options);

/// Metadata and matrices of a header: its string attributes, and its attributes of 4x4 matrices.
ExrOptions readOptions(const Imf::Header& header);

/// Writes all rows of the header's data window. Throws whatever keeps the file from being complete.
void writeExrPixels(const std::filesystem::path& file, const Imf::Header& header, const Imf::FrameBuffer& frame);

}  // namespace freevoxels
