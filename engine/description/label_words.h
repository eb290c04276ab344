#pragma once
// Labels and channels as text: "all", "none", or which labels, with colours: "1,2=#d0a080,7=red@0.3", "all,3=white"; a channel with its
// colour and window: "dapi:blue:100,4000".

#include <functional>
#include <string>

#include "engine/volume/channels.h"
#include "engine/volume/labels.h"

namespace freevoxels {

inline constexpr const char* kLabelsForm = "all|none|ID[=COLOR][@OPACITY],...";

/// Fails with ErrorKind::Usage; `name` is what the sentence calls the text.
Labels readLabels(const std::string& name, const std::string& text);
/// What readLabels reads.
std::string labelsText(const Labels& labels);

inline constexpr const char* kChannelForm = "NAME[:COLOR|FUNCTION][@WEIGHT][:LO,HI][:emission]";

/// The same of a channel.
ChannelStyle readChannel(const std::string& name, const std::string& text);
std::string channelText(const ChannelStyle& channel);
/// The text of a channel with the name of its transfer function changed, if it has one.
std::string withFunction(const std::string& name, const std::string& text, const std::function<std::string(const std::string&)>& change);

}  // namespace freevoxels
