// OME-Zarr: images of several resolutions, by https://ngff.openmicroscopy.org/0.4/ and /0.5/, and those of earlier versions that have no
// units and transforms.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <functional>
#include <system_error>

#include "engine/core/json_file.h"
#include "engine/core/machine.h"
#include "engine/image/srgb.h"
#include "engine/volume/length_unit.h"
#include "engine/volume/scan_reader.h"
#include "engine/volume/zarr_array.h"

namespace freevoxels {

namespace {

using NgffJson = nlohmann::json;

/// The axes of an image, by what they are; -1: there is none.
struct NgffAxes {
  std::size_t count = 0;
  std::array<int, 3> space{-1, -1, -1};  ///< x, y, z
  int time = -1, channel = -1;
  glm::dvec3 millimetres{1.0};  ///< of the units of x, y, z
};

/// Scale and translation along each axis of an array.
struct NgffTransform {
  std::vector<double> scale, translation;
};

struct NgffLevel {
  std::string path;
  NgffTransform transform;
};

const NgffJson& memberOf(const NgffJson& object, const char* key) {
  static const NgffJson none;
  const auto found = object.is_object() ? object.find(key) : object.end();
  return object.is_object() && found != object.end() ? *found : none;
}

std::string stringOf(const NgffJson& object, const char* key) {
  const NgffJson& value = memberOf(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

/// The metadata of OME in a group; null where there is no group.
NgffJson groupAttributes(const FileStore& store, const std::string& folder) {
  const auto at = [&](const char* name) { return folder.empty() ? std::string(name) : folder + "/" + name; };
  if (const NgffJson third = zarrJson(store, at("zarr.json")); third.is_object()) {
    const NgffJson& attributes = memberOf(third, "attributes");
    return memberOf(attributes, "ome").is_object() ? memberOf(attributes, "ome") : attributes;
  }
  return zarrJson(store, at(".zattrs"));
}

/// What omero says of a channel.
ScanChannel channelOf(const NgffJson& json) {
  ScanChannel channel{.name = stringOf(json, "label")};
  const std::string hex = stringOf(json, "color");
  std::uint32_t color = 0;
  const auto [end, error] = std::from_chars(hex.data(), hex.data() + hex.size(), color, 16);
  if (hex.size() == 6 && error == std::errc() && end == hex.data() + hex.size())
    channel.color = glm::vec3(linearFromSrgb(float(color >> 16) / 255.0f), linearFromSrgb(float(color >> 8 & 255) / 255.0f),
                              linearFromSrgb(float(color & 255) / 255.0f));
  const NgffJson &window = memberOf(json, "window"), &start = memberOf(window, "start"), &stop = memberOf(window, "end");
  const auto isUsable = [](const NgffJson& value) { return value.is_number() && std::abs(value.get<double>()) < 1e30; };
  if (isUsable(start) && isUsable(stop) && start.get<float>() < stop.get<float>()) channel.window = {start.get<float>(), stop.get<float>()};
  if (const NgffJson& active = memberOf(json, "active"); active.is_boolean()) channel.isShown = active.get<bool>();
  return channel;
}

/// Whether channels are said to be the red, green and blue of colours: by their names, or as programs write those of 8 bits, of which all
/// values are shown.
bool areChannelsOfColors(const std::vector<ScanChannel>& channels, SampleType type) {
  constexpr std::array<std::string_view, 3> kNames{"red", "green", "blue"};
  if (!areColors(int(channels.size()), type)) return false;
  bool areNamed = true, areShownWhole = type == SampleType::U8;
  for (std::size_t c = 0; c < kNames.size(); ++c) {
    std::string name = channels[c].name;
    std::ranges::transform(name, name.begin(), [](unsigned char character) { return char(std::tolower(character)); });
    areNamed &= name == kNames[c] || name == kNames[c].substr(0, 1);
    glm::vec3 pure(0.0f);
    pure[int(c)] = 1.0f;
    areShownWhole &= channels[c].color == pure && channels[c].window.value_or(std::array{0.0f, 255.0f}) == std::array{0.0f, 255.0f};
  }
  return areNamed || areShownWhole;
}

class NgffScan : public ScanReader {
 public:
  NgffScan(const std::filesystem::path& file, const ScanRequest& request) : path_(file) {
    std::error_code error;
    store_ = std::filesystem::is_directory(file, error) ? openFolderStore(file) : openZipStore(file);
    const NgffJson attributes = findImage();
    const NgffJson& image = memberOf(attributes, "multiscales")[0];
    takeAxes(image);
    takeLevels(image);
    header_.format =
        fmt::format("OME-Zarr {}", stringOf(attributes, "version").empty() ? stringOf(image, "version") : stringOf(attributes, "version"));
    if (header_.format.ends_with(' ')) header_.format.pop_back();
    openArrays();
    takeChannels(memberOf(memberOf(attributes, "omero"), "channels"));
    chooseLevel(request);
  }

  void read(const ScanPart& part, const SampleSink& sink, const Progress& progress) override {
    ZarrBox box{.axes = axes_.space, .place = std::vector<std::uint64_t>(axes_.count, 0)};
    if (axes_.time >= 0) box.place[std::size_t(axes_.time)] = std::uint64_t(part.timeStep);
    if (axes_.channel >= 0) box.place[std::size_t(axes_.channel)] = std::uint64_t(part.channel);
    if (part.box) {
      box.first = part.box->first;
      box.last = part.box->last;
    }
    arrays_[std::size_t(header_.level)]->read(box, sink, progress);
  }

  std::uint64_t bytesToRead() const override { return arrays_[std::size_t(header_.level)]->bytesToRead(); }

 private:
  /// The metadata of the image: that of the file, or of the first image in it.
  NgffJson findImage() {
    NgffJson attributes = groupAttributes(*store_, "");
    if (!attributes.is_object())
      fail(ErrorKind::Input, "'{}' is no Zarr group: name the folder or archive that has .zattrs or zarr.json", path_.string());
    if (memberOf(attributes, "plate").is_object())
      fail(ErrorKind::Input, "'{}' is a plate of several images: name one of them, such as '{}/A/1/0'", path_.string(), path_.string());
    if (memberOf(attributes, "bioformats2raw.layout").is_number()) {
      folder_ = "0/";
      attributes = groupAttributes(*store_, "0");
    }
    const NgffJson& scales = memberOf(attributes, "multiscales");
    if (!scales.is_array() || scales.empty() || !memberOf(scales[0], "datasets").is_array() || memberOf(scales[0], "datasets").empty())
      fail(ErrorKind::Input,
           "'{}' is a Zarr hierarchy without multiscales, which say what its arrays are: write it as OME-Zarr, or convert "
           "the array to NRRD or TIFF",
           path_.string());
    return attributes;
  }

  void takeAxes(const NgffJson& image) {
    constexpr std::array<const char*, 5> kFirstVersions{"t", "c", "z", "y", "x"};
    NgffJson list = memberOf(image, "axes");
    if (list.is_null()) list = kFirstVersions;
    if (!list.is_array()) failDamaged(path_, "its axes are no list");
    axes_.count = list.size();
    for (std::size_t i = 0; i < list.size(); ++i) takeAxis(list[i], int(i));
    if (axes_.space[0] < 0 || axes_.space[1] < 0) fail(ErrorKind::Input, "'{}' has no axes x and y: write it with them", path_.string());
  }

  void takeAxis(const NgffJson& json, int number) {
    const std::string name = json.is_string() ? json.get<std::string>() : stringOf(json, "name"), type = stringOf(json, "type");
    if (name.size() == 1 && name[0] >= 'x' && name[0] <= 'z') {
      const int axis = name[0] - 'x';
      axes_.space[std::size_t(axis)] = number;
      const std::optional<double> unit = millimetresOf(stringOf(json, "unit"));
      axes_.millimetres[axis] = unit.value_or(1.0);
      if (unit) header_.space = ScanSpace::Millimetres;
    } else if (type == "time" || name == "t") {
      axes_.time = number;
    } else if (type == "channel" || name == "c") {
      axes_.channel = number;
    }
  }

  void takeLevels(const NgffJson& image) {
    for (const NgffJson& dataset : memberOf(image, "datasets")) {
      NgffLevel level{.path = stringOf(dataset, "path"),
                      .transform = {std::vector<double>(axes_.count, 1.0), std::vector<double>(axes_.count, 0.0)}};
      const std::filesystem::path path(level.path);
      const bool leaves = path.is_absolute() || std::ranges::find(path, "..") != path.end();
      if (level.path.empty() || leaves) failDamaged(path_, "it has a dataset whose path is none in it");
      while (level.path.ends_with('/')) level.path.pop_back();
      apply(memberOf(dataset, "coordinateTransformations"), level.transform);
      apply(memberOf(image, "coordinateTransformations"), level.transform);
      levels_.push_back(std::move(level));
    }
  }

  void apply(const NgffJson& transforms, NgffTransform& transform) const {
    for (const NgffJson& one : transforms.is_array() ? transforms : NgffJson::array()) {
      const std::string type = stringOf(one, "type");
      if (type == "identity") continue;
      const NgffJson& numbers = memberOf(one, type == "scale" ? "scale" : "translation");
      if ((type != "scale" && type != "translation") || numbers.is_null())
        fail(ErrorKind::Input, "'{}' has the transformation {}, and scales and translations in its metadata are read: write it with these",
             path_.string(), inShort(one));
      if (!numbers.is_array() || numbers.size() != axes_.count || !std::ranges::all_of(numbers, &NgffJson::is_number))
        failDamaged(path_, "it has a transformation without a number for each axis");
      for (std::size_t axis = 0; axis < axes_.count; ++axis) {
        const auto number = numbers[axis].get<double>();
        if (type == "scale") transform.scale[axis] *= number;
        transform.translation[axis] = type == "scale" ? transform.translation[axis] * number : transform.translation[axis] + number;
      }
    }
  }

  glm::i64vec3 extentOf(const ZarrLayout& layout) const {
    glm::i64vec3 extent(1);
    for (int axis = 0; axis < 3; ++axis)
      if (const int of = axes_.space[std::size_t(axis)]; of >= 0)
        extent[axis] = std::int64_t(std::min<std::uint64_t>(layout.shape[std::size_t(of)], std::uint64_t(1) << 40));
    return extent;
  }

  void openArrays() {
    constexpr std::uint64_t kMost = 1 << 20;
    for (const NgffLevel& level : levels_) {
      arrays_.push_back(std::make_unique<ZarrArray>(*store_, folder_ + level.path));
      const ZarrLayout& layout = arrays_.back()->layout();
      if (layout.shape.size() != axes_.count)
        failDamaged(path_, fmt::format("its array '{}' has {} axes, and its metadata {}", level.path, layout.shape.size(), axes_.count));
      const glm::i64vec3 extent = extentOf(layout);
      checkEdges(path_, extent);
      header_.levels.emplace_back(extent);
      for (std::size_t axis = 0; axis < axes_.count; ++axis) {
        const bool isKnown =
            std::ranges::find(axes_.space, int(axis)) != axes_.space.end() || int(axis) == axes_.time || int(axis) == axes_.channel;
        if (!isKnown && layout.shape[axis] != 1)
          fail(ErrorKind::Input, "'{}' has an axis that is none of t, c, z, y and x: take a part of it", path_.string());
        if (layout.shape[axis] > kMost) failDamaged(path_, fmt::format("its array '{}' has an edge of {}", level.path, layout.shape[axis]));
      }
    }
    const auto countOf = [&](int axis) { return axis < 0 ? 1 : int(arrays_.front()->layout().shape[std::size_t(axis)]); };
    header_.timeSteps = countOf(axes_.time);
    channels_ = countOf(axes_.channel);
    for (const std::unique_ptr<ZarrArray>& array : arrays_)
      for (const int axis : {axes_.time, axes_.channel})
        if (axis >= 0 && array->layout().shape[std::size_t(axis)] != std::uint64_t(countOf(axis)))
          failDamaged(path_, "its levels have different channels or time steps");
  }

  void takeChannels(const NgffJson& described) {
    if (channels_ < 2) return;
    const bool isDescribed = described.is_array() && described.size() == std::size_t(channels_);
    for (int i = 0; i < channels_; ++i) header_.channels.push_back(isDescribed ? channelOf(described[std::size_t(i)]) : ScanChannel());
    header_.areColors = areChannelsOfColors(header_.channels, arrays_.front()->layout().type);
  }

  /// The voxels of a level that are read: the clip box, of which the numbers are those of the level that is asked for, or of the finest.
  VoxelBox boxOf(const ScanRequest& request, int level) const {
    const glm::i64vec3 extent(header_.levels[std::size_t(level)]);
    if (!request.clipBox) return {.first = glm::ivec3(0), .last = glm::ivec3(extent - 1l)};
    const glm::i64vec3 counted(header_.levels[std::size_t(request.pyramidLevel.value_or(0))]), first(request.clipBox->first);
    const glm::i64vec3 end = glm::min(glm::i64vec3(request.clipBox->last) + 1l, counted);
    return {.first = glm::ivec3(first * extent / counted), .last = glm::ivec3((end * extent + counted - 1l) / counted - 1l)};
  }

  void checkLevelAndBox(const ScanRequest& request) const {
    const int count = int(header_.levels.size()), level = request.pyramidLevel.value_or(0);
    if (level >= count)
      fail(ErrorKind::Usage, "{} is none of '{}', which has {} level{}, counted from 0, the finest",
           Parameter("pyramid-level", fmt::format("{}", level)), path_.string(), count, count == 1 ? "" : "s");
    const glm::ivec3 size = header_.levels[std::size_t(level)];
    if (request.clipBox && glm::any(glm::greaterThanEqual(request.clipBox->first, size)))
      fail(ErrorKind::Usage, "{} has no voxel of level {} of '{}', which has {} x {} x {}", Parameter("clip-box"), level, path_.string(),
           size.x, size.y, size.z);
  }

  /// The finest level that fits into a quarter of the memory and is not much finer than the image.
  void chooseLevel(const ScanRequest& request) {
    constexpr double kFinest = 1.5;  // voxels a pixel
    checkLevelAndBox(request);
    const int count = int(header_.levels.size());
    const double sums = header_.channels.empty() ? 1.0 : double(std::min(header_.channels.size(), kMaxChannels)) + 4.0;
    const auto isTooFine = [&](int level) {
      const VoxelBox box = boxOf(request, level);
      const glm::ivec3 size = box.last - box.first + 1;
      const double voxels = double(size.x) * double(size.y) * double(size.z);
      return voxels * sums * sizeof(float) > double(std::min(machineMemoryBytes(), request.memoryBytes)) / 4.0 ||
             (request.maximumVoxels > 0 && voxels > double(request.maximumVoxels)) ||
             (request.imageEdge > 0 && std::max({size.x, size.y, size.z}) > kFinest * request.imageEdge);
    };
    int level = 0;
    while (level + 1 < count && isTooFine(level)) ++level;
    if (!request.pyramidLevel && level > 0)
      header_.remarks.push_back(
          fmt::format("level {} of its {} is drawn, the finest that the image or memory has a use for ({} chooses "
                      "another)",
                      level, count, Parameter("pyramid-level")));
    takeLevel(request.pyramidLevel.value_or(level));
    if (request.clipBox) header_.part = boxOf(request, header_.level);
  }

  void takeLevel(int number) {
    header_.level = number;
    header_.dimensions = header_.levels[std::size_t(number)];
    header_.type = arrays_[std::size_t(number)]->layout().type;
    const NgffTransform& transform = levels_[std::size_t(number)].transform;
    for (int axis = 0; axis < 3; ++axis) {
      const int of = axes_.space[std::size_t(axis)];
      if (of < 0) continue;
      header_.indexToWorld[axis][axis] = transform.scale[std::size_t(of)] * axes_.millimetres[axis];
      header_.indexToWorld[3][axis] = transform.translation[std::size_t(of)] * axes_.millimetres[axis];
    }
    if (axes_.space[2] < 0) header_.indexToWorld[2][2] = header_.indexToWorld[1][1];
  }

  const std::filesystem::path path_;
  std::unique_ptr<FileStore> store_;
  std::string folder_;  ///< of the image in the store, with "/"; or empty
  NgffAxes axes_;
  std::vector<NgffLevel> levels_;
  std::vector<std::unique_ptr<ZarrArray>> arrays_;  ///< of the levels
  int channels_ = 1;
};

}  // namespace

std::unique_ptr<ScanReader> openNgffScan(const std::filesystem::path& file, const ScanRequest& request) {
  return std::make_unique<NgffScan>(file, request);
}

}  // namespace freevoxels
