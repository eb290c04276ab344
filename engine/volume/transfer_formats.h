#pragma once
// Transfer functions in files of other programs, recognised by what is in them:
// - ParaView's JSON, of which VolView's presets are a kind: RGBPoints, Points or OpacityPoints, ColorSpace, IndexedColors;
// - 3D Slicer: .vp, .vp.json, and the VolumeProperty nodes of presets.xml and of scenes (.mrml);
// - ImageVis3D's tables (.1dt), Inviwo's .itf and Voreen's .tfi.
// All functions fail with ErrorKind::Input and a sentence that names the file.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/volume/transfer_curves.h"

namespace freevoxels {

/// The text of a file and which of its functions is meant.
struct TransferText {
  std::string name;    ///< what sentences call it: the file's name
  std::string text;    ///< what is in it
  std::string wanted;  ///< the name of one of several functions; empty: the only one
};

/// The curves of any known format, ours included.
TransferCurves readTransferText(const TransferText& file);

/// The index of the function that is wanted among those of a file, which have these names.
std::size_t indexOfWanted(const TransferText& file, const std::vector<std::string>& names);

/// Whether JSON is that of another program, and its curves.
bool isForeignJson(const nlohmann::json& root);
TransferCurves readForeignJson(const TransferText& file, const nlohmann::json& root);
TransferCurves readSlicerJson(const TransferText& file, const nlohmann::json& root);

/// XML of 3D Slicer, Inviwo or Voreen.
TransferCurves readTransferXml(const TransferText& file);

/// The numbers of a .1dt or a .vp; nothing if the text is neither.
std::optional<TransferCurves> readTransferNumbers(const TransferText& file);

/// What 3D Slicer stores as text: the count of numbers, and so many.
struct SlicerTexts {
  std::string scalarOpacity, gradientOpacity, color;
};
TransferCurves readSlicerTexts(const TransferText& file, const SlicerTexts& texts);

/// The warning about a gradient opacity, which ours have not.
inline constexpr const char* kGradientOpacityIsLost = "its gradient opacity is not drawn";

}  // namespace freevoxels
