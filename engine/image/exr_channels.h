#pragma once
// Which channels of an OpenEXR file make a colour image, and in what colours they are. For sources that use OpenEXR.

#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>

#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>

namespace freevoxels {

struct ExrColors {
  int part = 0;
  std::array<std::string, 4> names;  ///< of red, green, blue and alpha; the last may be missing. Luminance alone has one name three times
  std::string depth;                 ///< empty if there is none
};

/// One channel of one part.
struct ExrChannel {
  int part = 0;
  std::string name;
};

/// The depth: Z of the first part that has it; else the only Z of a layer that is called depth, as "ViewLayer.Depth.Z", in any case; else
/// the file's only channel. Fails with ErrorKind::Input.
ExrChannel findDepth(const std::filesystem::path& file, const Imf::MultiPartInputFile& exr);

/// R, G and B of the first part that has them; else of the only layer, or of one that renderers call their image (Combined, rgba, beauty);
/// else Y alone, as grey. Fails with ErrorKind::Input, which lists the layers.
ExrColors findColors(const std::filesystem::path& file, const Imf::MultiPartInputFile& exr);

/// From the header's chromaticities to linear Rec.709, adapted to its white by Bradford's method unless the colours are CIE XYZ; nothing
/// where they are those of Rec.709 already, or the header does not say.
std::optional<glm::dmat3> toRec709(const Imf::Header& header);

}  // namespace freevoxels
