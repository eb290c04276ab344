#pragma once
// Which part of a frame a command draws, and whether it writes the part's sums for `freevoxels merge`.

#include <optional>
#include <string>

#include "apps/common/option_values.h"
#include "engine/scene/render_settings.h"
#include "engine/splatting/shares.h"

namespace freevoxels {

struct ShareOptions {
  std::optional<SharePart> part;
  bool sums = false;
  std::optional<int> coloredParts;  ///< number of parts that an image shows by colours

  void add(CLI::App& app);
  /// Fails with ErrorKind::Usage where the options contradict each other.
  void check() const;
  /// Whether frames are drawn share by share.
  bool isGiven() const { return part.has_value() || sums || coloredParts.has_value(); }
  /// All shares where the option is not given.
  SharePart whole() const { return part.value_or(SharePart{}); }
};

/// "2/7" as the third of seven parts. Fails with ErrorKind::Usage; `name` is what the sentence calls the text.
SharePart readSharePart(const std::string& name, const std::string& text);
std::string sharePartText(const SharePart& part);

/// Fails with ErrorKind::Usage where there are more processes than shares.
void checkRanks(int ranks);

/// Settings of a frame that is drawn share by share. Fails with ErrorKind::Usage where a method was asked for that cannot be divided.
FrameSettings sharedSettings(FrameSettings settings);

}  // namespace freevoxels
