#pragma once
// Adds up the parts of an image that were drawn share by share.

#include <span>
#include <string>

#include "engine/description/scene_description.h"

namespace freevoxels {

/// Whether a file holds the sums of shares.
bool isPartOfImage(const std::string& file);

/// Adds up files of sums, which have each share once, and writes the image that they are. Fails with ErrorKind::Input for parts of
/// different images, and for shares that are missing or there twice.
void mergeParts(std::span<const std::string> parts, const OutputDescription& output, std::span<const std::string> images);

}  // namespace freevoxels
