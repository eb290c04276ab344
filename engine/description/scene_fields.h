#pragma once
// Every field of a scene description by name, with its form and its conversion to and from text: the one list from which scene files,
// the command line and the keywords of library and Python are made.

#include <functional>
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/description/scene_description.h"

namespace freevoxels {

/// The words of enumerators, of which the first has the value `first` and the others follow.
template <typename Enum>
struct Words {
  std::vector<std::string> texts;
  int first = 0;

  const std::string& of(Enum value) const { return texts[std::size_t(int(value) - first)]; }
  Enum at(int index) const { return Enum(first + index); }
};
inline const Words<ClassificationOrder> kOrderWords{{"post", "pre"}};
inline const Words<Shading> kShadingWords{{"auto", "scatter", "gradient"}};
inline constexpr const char* kAllOrdersWord = "all";  ///< kAllOrders
inline const Words<LightAttenuation> kLightAttenuationWords{{"table", "exact", "auto"}};
inline const Words<IntensityProjection> kModeWords{{"volume", "mip", "average"}};
inline const Words<Draw> kDrawWords{{"gather", "splats"}};
inline const Words<Composite> kCompositeWords{{"normalised", "additive", "sorted"}};
inline const Words<AttenuationLookup> kAttenuationWords{{"bilinear", "nearest"}};
inline const Words<DirectionSet> kDirectionWords{{"26", "98"}, 1};
inline const Words<AttenuationCode> kCodeWords{{"depth8", "linear8"}};
inline const Words<HierarchyFilter> kHierarchyFilterWords{{"geometric", "arithmetic"}};
inline const Words<ToneMap> kToneMapWords{{"none", "filmic", "aces"}};
inline const Words<PngBits> kPngBitsWords{{"8", "16"}};

struct SceneField {
  enum class Kind {
    Value,       ///< numbers or words
    Channel,     ///< how a channel is drawn (label_words.h), which may name a transfer function
    Keys,        ///< KEY=VALUE with commas between them
    Volumes,     ///< another volume: a file with KEY=VALUE behind it, or JSON that begins with {
    Name,        ///< a name, whatever it looks like
    Volume,      ///< a file, or procedural:NAME
    File,        ///< a file
    Function,    ///< a transfer function: a file, FILE:NAME, a preset, or JSON that begins with {
    InlineJson,  ///< a file of JSON, or JSON that begins with {
    Flag,        ///< "true" or "false", which is that of a field that is not given
    Switch,      ///< "true" or "false"
  };
  std::string section, name;  ///< of the scene file; the name is also that of the Parameter
  Kind kind = Kind::Value;
  std::string form;          ///< of the text: "X,Y,Z"
  bool repeated = false;     ///< whether there may be several texts
  bool standsAlone = false;  ///< whether the text may be empty, or kNone, which the command line has as --no-NAME
  /// Names of fields with which this one cannot be given, and of those of weaker sources that it replaces.
  std::vector<std::string> excludes, replaces;
  /// Gives the field. There is one text, unless it is repeated. Fails with ErrorKind::Usage.
  std::function<void(SceneDescription&, const std::vector<std::string>&)> read;
  /// The texts that read() takes; none if the field is not given.
  std::function<std::vector<std::string>(const SceneDescription&)> texts;

  std::string plural = {};  ///< name + "s" where it is empty

  /// The key in a scene file: "lights" for "light".
  std::string key() const { return !repeated ? name : plural.empty() ? name + "s" : plural; }
  bool isFile() const { return kind == Kind::Volume || kind == Kind::File || kind == Kind::Function || kind == Kind::InlineJson; }
  bool isOrExcludes(const SceneField& other) const;
};

/// All fields by sections, in the order of SceneDescription.
const std::vector<SceneField>& sceneFields();
/// The field of this name.
const SceneField& sceneField(std::string_view name);
bool isSceneSection(std::string_view name);

using SceneFieldSet = std::set<const SceneField*>;
/// Whether fields that a stronger source gives take the place of this field: one is it, excludes it or replaces it.
bool isReplaced(const SceneField& field, const SceneFieldSet& stronger);

/// What a description gives of the fields for which `wanted` is true.
SceneDescription partOf(const SceneDescription& description, const std::function<bool(const SceneField&)>& wanted);
/// A text that is equal for descriptions with equal fields in these sections.
std::string textOf(const SceneDescription& description, std::initializer_list<std::string_view> sections);

}  // namespace freevoxels
