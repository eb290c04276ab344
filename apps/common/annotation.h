#pragma once
// Bars over an image (MethodDescription::annotate): the colours of the transfer function with their values, and a length of the world.

#include <string>
#include <vector>

#include "engine/description/scene_description.h"
#include "engine/image/image.h"

namespace freevoxels {

/// Whether a scene has something to annotate: a transfer function that is not of an isosurface, or an image without perspective.
bool canAnnotate(const SceneDescription& description, const Scene& scene);

/// Draws the bars where the description asks for them, into the part of the image that it keeps (OutputDescription::crop). Their sizes
/// follow that of the part.
void annotate(Image& image, const SceneDescription& description, const Scene& scene);

/// Three to five round values of a range, ascending: multiples of 1, 2, 2.5 or 5 times a power of ten.
std::vector<double> roundValues(double low, double high);
/// The largest length that is 1, 2 or 5 times a power of ten and not above this one.
double roundLength(double most);
/// Such a length with its unit: "20 mm", "500 µm", "10 cm"; "0.2" where the unit is not known.
std::string lengthText(double length, const std::string& unit);

}  // namespace freevoxels
