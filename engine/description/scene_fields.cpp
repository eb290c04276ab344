#include "engine/description/scene_fields.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/description/added_volume.h"
#include "engine/description/label_words.h"
#include "engine/description/scene_field_codecs.h"
#include "engine/description/text_values.h"
#include "engine/scene/draft_quality.h"

namespace freevoxels {

namespace {

using namespace scene_field;

constexpr int kBeyondAnything = 1 << 20;  ///< larger than coordinates of voxels and pixels

constexpr NumberRange kPositive{.minimum = 0.0}, kUnit{.minimum = 0.0, .maximum = 1.0};

NoData readNoData(const std::string& name, const std::string& given) {
  if (given == kNone) return {};
  return {.value = readNumbers({.name = name, .form = "VALUE or none", .count = 1}, given)[0]};
}

constexpr const char* kIsoForm = "VALUE[,COLOR]";

IsoSurface readIsoSurface(const std::string& name, const std::string& given) {
  const std::size_t comma = given.find(',');
  IsoSurface surface{.value = readNumbers({.name = name, .form = kIsoForm, .count = 1}, given.substr(0, comma))[0]};
  if (comma == std::string::npos) return surface;
  if (const std::optional<glm::dvec3> named = namedColor(given.substr(comma + 1))) {
    surface.color = *named;
    return surface;
  }
  const std::vector<double> color = readNumbers({.name = name, .form = kIsoForm, .count = 3, .range = kUnit}, given.substr(comma + 1));
  surface.color = {color[0], color[1], color[2]};
  return surface;
}

std::string isoSurfaceText(const IsoSurface& surface) {
  const std::string value = numberText(surface.value);
  return surface.color == IsoSurface{}.color ? value : value + "," + numberText(surface.color);
}

void addInput(std::vector<SceneField>& fields) {
  using Input = InputDescription;
  Section<Input> section(fields, "input", &SceneDescription::input);
  section.add("volume", &Input::volume, text(Kind::Volume, "the name of a volume")).replaces = {
      "grid", "resolution", "clip-box", "clip-plane", "no-data", "raw", "series", "time-step", "spacing", "pyramid-level"};
  section.add("grid", &Input::grid, text(Kind::Name, "NAME"));
  Codec<glm::ivec3> resolution = extent<glm::ivec3>("WxHxD", kMaxResolution);
  resolution.text = [](const glm::ivec3& size) { return resolutionText(size); };
  section.add("resolution", &Input::resolution, resolution);
  section.add("clip-box", &Input::clipBox,
              numbers<VoxelBox>({.form = "X0,Y0,Z0,X1,Y1,Z1", .range = {0.0, double(kBeyondAnything)}}));
  section.add("no-data", &Input::noData, Codec<NoData>{.form = "VALUE|none", .read = readNoData, .text = [](const NoData& marks) {
                                                         return marks.value ? numberText(*marks.value) : std::string(kNone);
                                                       }});
  section.add("raw", &Input::raw,
              Codec<RawLayout>{.form = "WxHxD,TYPE[,big][,header=BYTES]", .read = readRawLayout, .text = rawLayoutText});
  section.add("series", &Input::series, text(Kind::Name, "UID"));
  section.add("time-step", &Input::timeStep, numbers<int>({.form = "N", .range = {0.0, double(kBeyondAnything)}, .whole = true}));
  section.add("spacing", &Input::spacing, numbers<glm::dvec3>({.form = "X,Y,Z", .range = kPositive, .mayBeOne = true}));
  section.add("pyramid-level", &Input::pyramidLevel, numbers<int>({.form = "N", .range = {0.0, 64.0}, .whole = true}));
  section.add("clip-plane", &Input::clipPlane, numbers<ClipPlane>({.form = "X,Y,Z,NX,NY,NZ", .range = {-1e30, 1e30}}));
}

void addVolumes(std::vector<SceneField>& fields) {
  Section<std::vector<AddedVolume>> section(fields, "volumes", &SceneDescription::added);
  SceneField& added = section.add(
      "add", Kind::Volumes, "FILE[,KEY=VALUE...]",
      [](std::vector<AddedVolume>& volumes, const Texts& given) {
        volumes.clear();
        for (const std::string& one : given) volumes.push_back(readAddedVolume(one));
      },
      [](const std::vector<AddedVolume>& volumes) {
        Texts texts;
        for (const AddedVolume& one : volumes) texts.push_back(addedVolumeText(one));
        return texts;
      });
  added.repeated = true;
  added.plural = "volumes";
}

void addClassification(std::vector<SceneField>& fields) {
  using Classified = ClassificationDescription;
  Section<Classified> section(fields, "classification", &SceneDescription::classification);
  section.add("density-scale", &Classified::densityScale, numbers<double>({.form = "S", .range = kPositive}));
  section.add("albedo", &Classified::albedo, numbers<glm::dvec3>({.form = "R,G,B", .range = kUnit}));
  section.add("albedo-grid", &Classified::albedoGrid, text(Kind::Name, "NAME"));
  section.add("transfer-function", &Classified::transferFunction, text(Kind::Function, "FILE|PRESET")).excludes = {"density-scale",
                                                                                                                   "albedo", "albedo-grid"};
  section.add("window", &Classified::window, Codec<ValueWindow>{.form = kWindowForm, .read = readWindow, .text = windowText}).excludes = {
      "density-scale", "albedo", "albedo-grid"};
  section.add("opacity", &Classified::opacity, numbers<double>({.form = "FACTOR", .range = {kMinOpacity, kMostOpacity}}));
  section.add("invert", &Classified::invert, truth(Kind::Flag)).excludes = {"density-scale", "albedo", "albedo-grid"};
  section.add("iso", &Classified::iso, Codec<IsoSurface>{.form = kIsoForm, .read = readIsoSurface, .text = isoSurfaceText}).excludes = {
      "transfer-function", "density-scale", "albedo", "albedo-grid", "window", "opacity", "invert"};
  section.add("classification", &Classified::order, words(kOrderWords));
  SceneField& labels =
      section.add("labels", &Classified::labels, Codec<Labels>{.form = kLabelsForm, .read = readLabels, .text = labelsText});
  labels.excludes = {"transfer-function", "iso", "albedo-grid", "window", "invert"};
  SceneField& channels = section.add(
      "channel", Kind::Channel, kChannelForm,
      [](Classified& classified, const Texts& given) {
        classified.channels.clear();
        for (const std::string& one : given) classified.channels.push_back(readChannel(marked("channel"), one));
      },
      [](const Classified& classified) {
        Texts texts;
        for (const ChannelStyle& channel : classified.channels) texts.push_back(channelText(channel));
        return texts;
      });
  channels.repeated = true;
  channels.excludes = {"transfer-function", "iso", "window", "invert", "albedo", "albedo-grid", "labels", "temperature-grid"};
}

void addEmission(std::vector<SceneField>& fields) {
  using Emitted = EmissionDescription;
  Section<Emitted> section(fields, "emission", &SceneDescription::emission);
  section.add("temperature-grid", &Emitted::temperatureGrid, text(Kind::Name, "NAME"));
  SceneField& emission = section.add(
      "emission", Kind::Value, "STRENGTH|none",
      [](Emitted& emitted, const Texts& given) {
        emitted.strength.reset();
        emitted.emission = given.back() != kNone;
        if (!*emitted.emission) return;
        const auto values = readNumbers({.name = marked("emission"), .form = "STRENGTH", .count = 0, .range = kPositive}, given.back());
        emitted.strength = values.empty() ? std::nullopt : std::optional(values[0]);
      },
      [](const Emitted& emitted) {
        if (emitted.strength) return Texts{numberText(*emitted.strength)};
        return !emitted.emission ? Texts{} : Texts{*emitted.emission ? "" : kNone};
      });
  emission.standsAlone = true;
  section.add("temperature-scale", &Emitted::temperatureScale, numbers<double>({.form = "K", .range = kPositive}));
  section.add("temperature-offset", &Emitted::temperatureOffset, numbers<double>({.form = "K"}));
}

void addCamera(std::vector<SceneField>& fields) {
  using View = CameraDescription;
  Section<View> section(fields, "camera", &SceneDescription::camera);
  section.add("camera-position", &View::position, numbers<glm::dvec3>({.form = "X,Y,Z"}));
  section.add("orbit", &View::orbit, numbers<glm::dvec2>({.form = "AZIMUTH,ELEVATION"})).excludes = {"camera-position"};
  section.add("look-at", &View::lookAt, numbers<glm::dvec3>({.form = "X,Y,Z"}));
  section.add("up", &View::up, numbers<glm::dvec3>({.form = "X,Y,Z"}));
  section.add("fov", &View::verticalFov, numbers<double>({.form = "DEG"}));
  section.add("orthographic", &View::orthographicHeight, numbers<double>({.form = "HEIGHT"})).excludes = {"fov"};
  section.add("flight", &View::flight, text(Kind::InlineJson, "FILE.json")).excludes = {"camera-position", "orbit", "look-at", "up", "fov",
                                                                                        "orthographic"};
  section.add("size", &View::size, extent<glm::ivec2>("WxH", kMaxImageEdge));
  section.add("frames", &View::frames, numbers<int>({.form = "N", .range = {1.0, double(kMaximumFrames)}, .whole = true}));
  section.add("holdout", &View::holdout, text(Kind::File, "DEPTH.exr"));
}

constexpr const char* kLightForm = "direction=X,Y,Z[,color=R,G,B][,intensity=I] or position=X,Y,Z[,...]";

glm::dvec3 lightTriple(const char* what, const char* form, const std::string& text, NumberRange range = {}) {
  const auto n = readNumbers({.name = fmt::format("{} {}", Parameter("light"), what), .form = form, .count = 3, .range = range}, text);
  return {n[0], n[1], n[2]};
}

LightingDescription::GivenLight readLight(const std::string& text) {
  LightingDescription::GivenLight given;
  const Parameter name("light");
  bool placed = false;
  for (const auto& [key, value] : readKeys(marked("light"), kLightForm, text)) {
    if (key == "direction" || key == "position") {
      if (placed) fail(ErrorKind::Usage, "{} '{}' has a direction and a position: give one of them", name, quotedPart(text));
      placed = true;
      given.light.atInfinity = key == "direction";
      given.light.place = lightTriple(key.c_str(), "X,Y,Z", value);
      if (given.light.atInfinity && given.light.place == glm::dvec3(0.0))
        fail(ErrorKind::Usage, "{} '{}' has the direction 0,0,0, which points nowhere: give another", name, quotedPart(text));
    } else if (key == "color") {
      given.light.color = lightTriple("color", "R,G,B", value, kPositive);
    } else if (key == "intensity") {
      given.light.intensity = readNumbers({.name = marked("light") + " intensity", .form = "I", .range = kPositive}, value)[0];
      given.hasIntensity = true;
    } else {
      fail(ErrorKind::Usage, "{} knows no '{}': it takes {}", name, quotedPart(key), kLightForm);
    }
  }
  if (!placed) fail(ErrorKind::Usage, "{} '{}' has neither a direction nor a position: give one", name, quotedPart(text));
  return given;
}

std::string lightText(const LightingDescription::GivenLight& given) {
  const Light& light = given.light;
  const std::string intensity = given.hasIntensity ? ",intensity=" + numberText(light.intensity) : "";
  return fmt::format("{}={},color={}{}", light.atInfinity ? "direction" : "position", numberText(light.place), numberText(light.color),
                     intensity);
}

void addLights(Section<LightingDescription>& section) {
  SceneField& lights = section.add(
      "light", Kind::Keys, "direction|position=X,Y,Z[,color=R,G,B][,intensity=I]",
      [](LightingDescription& lighting, const Texts& given) {
        lighting.lights.clear();
        for (const std::string& one : given) lighting.lights.push_back(readLight(one));
      },
      [](const LightingDescription& lighting) {
        Texts texts;
        for (const auto& given : lighting.lights) texts.push_back(lightText(given));
        return texts;
      });
  lights.repeated = true;
}

void addLighting(std::vector<SceneField>& fields) {
  using Lit = LightingDescription;
  Section<Lit> section(fields, "light", &SceneDescription::lighting);
  section.add("unlit", &Lit::unlit, truth(Kind::Flag));
  section.add("light-attenuation", &Lit::attenuation, words(kLightAttenuationWords));
  section.add("shading", &Lit::shading, words(kShadingWords)).replaces = {"surface-share"};
  section.add("surface-share", &Lit::surface, numbers<double>({.form = "S", .range = kUnit}));
  Codec<int> orders = numbers<int>({.form = "all|N", .range = {1.0, double(kMaxOrders)}, .whole = true});
  orders.read = [number = orders.read](const std::string& name, const std::string& given) {
    return given == kAllOrdersWord ? kAllOrders : number(name, given);
  };
  orders.text = [number = orders.text](const int& count) { return count == kAllOrders ? std::string(kAllOrdersWord) : number(count); };
  section.add("scattering", &Lit::scattering, orders);
  addLights(section);
  Codec<glm::dvec3> ambient = numbers<glm::dvec3>({.form = "R,G,B", .range = kPositive});
  ambient.read = [](const std::string& name, const std::string& text) {
    const bool one = text.find(',') == std::string::npos && !namedColor(text);
    const auto n = readNumbers({.name = name, .form = one ? "L" : "R,G,B", .count = one ? 1u : 3u, .range = kPositive}, text);
    return one ? glm::dvec3(n[0]) : glm::dvec3(n[0], n[1], n[2]);
  };
  section.add("ambient", &Lit::ambient, ambient);
  section.add("environment", &Lit::environment, text(Kind::File, "FILE.exr"));
  section.add("environment-rotation", &Lit::environmentRotation, numbers<double>({.form = "DEG"}));
  section.add("environment-intensity", &Lit::environmentIntensity, numbers<double>({.form = "I", .range = kPositive}));
  section.add("extinction-tint", &Lit::tint, numbers<glm::dvec3>({.form = "R,G,B", .range = {kMinTint, kMaxTint}}));
  section.add("phase-g", &Lit::phaseG, numbers<double>({.form = "G", .range = {-kMaxPhaseG, kMaxPhaseG}}));
}

void addMethod(std::vector<SceneField>& fields) {
  using Method = MethodDescription;
  Section<Method> section(fields, "method", &SceneDescription::method);
  section.add("mode", &Method::mode, words(kModeWords));
  section.add("slice", &Method::slice, Codec<SlicePlane>{.form = kSliceForm, .read = readSlicePlane, .text = slicePlaneText}).excludes = {
      "mode", "iso", "add", "orbit", "camera-position", "look-at", "up", "fov", "orthographic", "flight", "holdout"};
  section.add("annotate", &Method::annotate, truth(Kind::Flag));
  section.add("composite", &Method::composite, words(kCompositeWords));
  section.add("draw", &Method::draw, words(kDrawWords));
  section.add("attenuation", &Method::attenuation, words(kAttenuationWords));
  section.add("directions", &Method::directions, words(kDirectionWords));
  section.add("code", &Method::code, words(kCodeWords));
  section.add("path-length-correction", &Method::pathLengthCorrection, truth(Kind::Switch));
  section.add("gradient", &Method::gradient, truth(Kind::Switch));
  section.add("lod", &Method::lod, numbers<double>({.form = "PIXELS", .range = {0.0, 1e6}}));
  section.add("quality", &Method::quality, numbers<double>({.form = "Q", .range = {DraftQuality::kLeast, 1.0}}));
  section.add("culling", &Method::culling, truth(Kind::Switch));
  section.add("cull-threshold", &Method::cullThreshold, numbers<double>({.form = "TRANSMITTANCE", .range = kUnit}));
  section.add("hierarchy-filter", &Method::hierarchyFilter, words(kHierarchyFilterWords));
  section.add("paper", &Method::paper, truth(Kind::Flag)).replaces = {"composite", "attenuation", "directions", "code",
                                                                     "path-length-correction", "gradient", "lod", "culling"};
}

void addOutput(std::vector<SceneField>& fields) {
  using Output = OutputDescription;
  Section<Output> section(fields, "output", &SceneDescription::output);
  section.add(
      "background", Kind::Value, "R,G,B|transparent",
      [](Output& output, const Texts& given) {
        output.background.reset();
        output.transparent = given.back() == "transparent";
        if (output.transparent) return;
        const NumberForm form{.name = marked("background"), .form = "R,G,B or transparent", .count = 3, .range = kUnit};
        const auto n = readNumbers(form, given.back());
        output.background = glm::dvec3(n[0], n[1], n[2]);
      },
      [](const Output& output) {
        if (output.transparent) return Texts{"transparent"};
        return output.background ? Texts{numberText(*output.background)} : Texts{};
      });
  section.add("exposure", &Output::exposure, numbers<double>({.form = "EV", .range = {-20.0, 20.0}}));
  section.add("tone-map", &Output::toneMap, words(kToneMapWords));
  section.add("float", &Output::fullFloat, truth(Kind::Flag));
  section.add("png-bits", &Output::pngBits, words(kPngBitsWords));
  section.add("aov", &Output::aovs,
              Codec<Aovs>{.form = "LIST", .read = readAovs, .text = [](const Aovs& aovs) { return aovText(aovs); }});
  section.add("crop", &Output::crop, numbers<PixelRectangle>({.form = "X,Y,W,H", .range = {0.0, double(kBeyondAnything)}}));
}

}  // namespace

bool SceneField::isOrExcludes(const SceneField& other) const {
  const auto has = [](const std::vector<std::string>& names, const std::string& one) {
    return std::ranges::find(names, one) != names.end();
  };
  return name == other.name || has(excludes, other.name) || has(other.excludes, name);
}

const std::vector<SceneField>& sceneFields() {
  static const std::vector<SceneField> fields = [] {
    std::vector<SceneField> all;
    all.reserve(80);  // so that references to fields stay valid
    for (const auto add : {addInput, addVolumes, addClassification, addEmission, addCamera, addLighting, addMethod, addOutput}) add(all);
    return all;
  }();
  return fields;
}

const SceneField& sceneField(std::string_view name) {
  const auto found = std::ranges::find(sceneFields(), name, &SceneField::name);
  if (found == sceneFields().end()) throw InternalError(fmt::format("no scene has a field '{}'", name));
  return *found;
}

bool isSceneSection(std::string_view name) {
  return std::ranges::find(sceneFields(), name, &SceneField::section) != sceneFields().end();
}

bool isReplaced(const SceneField& field, const SceneFieldSet& stronger) {
  return std::ranges::any_of(stronger, [&](const SceneField* other) {
    return other->isOrExcludes(field) || std::ranges::find(other->replaces, field.name) != other->replaces.end();
  });
}

SceneDescription partOf(const SceneDescription& description, const std::function<bool(const SceneField&)>& wanted) {
  SceneDescription part;
  for (const SceneField& field : sceneFields())
    if (const Texts texts = field.texts(description); !texts.empty() && wanted(field)) field.read(part, texts);
  return part;
}

std::string textOf(const SceneDescription& description, std::initializer_list<std::string_view> sections) {
  std::string text;
  for (const SceneField& field : sceneFields())
    if (std::ranges::find(sections, field.section) != sections.end())
      for (const std::string& one : field.texts(description)) text += fmt::format("{}={} ", field.name, one);
  return text;
}

}  // namespace freevoxels
