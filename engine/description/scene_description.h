#pragma once
// What an image shows, as plain data: the volume, how it looks, from where it is seen, how it is lit and drawn, and the form of the
// image. Whatever is not given is chosen for the volume when the description is resolved (resolve functions below).
//
// A description is read from and written to JSON (scene_json.h); the command line, the viewer, the library and Python all edit one.
// apps/scenes/README.md lists every field with unit, range and default; scene_fields.h is the same list as a table.
//
// Errors are of ErrorKind::Usage unless stated otherwise, and name Parameters.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/description/aov.h"
#include "engine/description/lighting_description.h"
#include "engine/image/image.h"
#include "engine/scene/camera.h"
#include "engine/scene/lighting.h"
#include "engine/scene/render_settings.h"
#include "engine/scene/table_settings.h"
#include "engine/storage/fvx_file.h"
#include "engine/volume/classification.h"
#include "engine/volume/coarse_volume.h"
#include "engine/volume/labels.h"
#include "engine/volume/raw_layout.h"
#include "engine/volume/scan.h"
#include "engine/volume/scan_file.h"
#include "engine/volume/scene_volume.h"
#include "engine/volume/slice.h"
#include "engine/volume/transfer_curves.h"
#include "engine/volume/vdb.h"
#include "engine/volume/volume.h"
#include "engine/volume/volume_source.h"

namespace freevoxels {

inline bool operator==(const PixelRectangle& a, const PixelRectangle& b) {
  return a.corner == b.corner && a.size == b.size;
}

/// Largest number of pixels along an edge of an image, and of voxels along an edge of a procedural volume.
inline constexpr int kMaxResolution = 2048;
inline constexpr int kDefaultResolution = 128;
/// The text of options that leave out what is there by default.
inline constexpr const char* kNone = "none";
/// Frames of a turn around the volume.
inline constexpr int kDefaultFrames = 72, kMaximumFrames = 100000;

/// What the name of a volume names.
enum class VolumeKind { Procedural, Baked, Scan, OpenVdb };

/// The volume, before it is read.
struct InputDescription {
  std::string volume;  ///< an OpenVDB file, a scan (scan_file.h), a folder of DICOM files, a baked volume (.fvx) or "procedural:NAME"
  std::optional<std::string> grid;  ///< of an OpenVDB file, as readVdb has it; else `density`, or the only float grid; of a scan an array
  std::optional<glm::ivec3> resolution;  ///< voxels of a procedural volume, 1 to kMaxResolution; else kDefaultResolution
  std::optional<VoxelBox> clipBox;       ///< in the volume's box; the voxels outside of it are not drawn
  std::optional<ClipPlane> clipPlane;    ///< the voxels in front of it are not drawn
  std::optional<NoData> noData;          ///< of a volume that is not baked; else the padding of a scan holds no data
  std::optional<RawLayout> raw;          ///< makes any file a scan without a header
  std::optional<std::string> series;     ///< of DICOM files, its UID
  std::optional<int> timeStep;           ///< of a scan with several, at least 0
  std::optional<glm::dvec3> spacing;     ///< of a scan, above 0; else as its file says
  std::optional<int> pyramidLevel;       ///< of a scan with several resolutions, at least 0, the finest; else as the image needs it
  /// What reading may use, as far as that can be chosen, such as the level of a scan. It is no option of the input.
  std::uint64_t memoryBytes = std::numeric_limits<std::uint64_t>::max();

  /// Fails without a volume.
  void checkGiven() const;
  /// Fails for fields that do not apply to this volume.
  void check() const;
  /// Gives the level of a scan with several that is read for an image of this many pixels along its longer edge, and the clip box in its
  /// voxels, so that neither depends on the image from now on. Leaves it to open() to say what is wrong with the file.
  void fixLevel(int imageEdge);
  /// The part of a volume in the clip box and behind the clip plane. Fails if there is none.
  Volume clip(Volume whole) const;
  bool isClipped() const { return clipBox || clipPlane; }
  /// The part of the whole volume where rays are marched in place of that.
  RayClip rayClip(const Volume& whole) const;
  /// Reads or makes the volume. A procedural volume has its temperatures if any are requested; a baked one always has its
  /// temperatures and albedos. If a baked volume is too large at `level` of its octree, the finest level that fits is
  /// opened, with a warning. `what`: more grids, labels and channels; the rest of it is that of the input. `progress` may abandon it.
  Volume open(std::uint64_t maximumVoxels, const ReadRequest& what = {}, int level = 0, const Progress& progress = {}) const;
  /// The one place that decides it: by the name, by the content of a file whose name says nothing, and by `raw`.
  VolumeKind kind() const;
  /// What to read of a scan.
  ScanRequest scanRequest(std::uint64_t maximumVoxels, const Progress& progress = {}) const;
  /// Null where the volume is not a baked one, and where it is clipped, so that it is read into memory.
  std::shared_ptr<const fvx::FvxFile> baked() const;

  bool operator==(const InputDescription&) const = default;
};

/// Positions and lengths in world units, angles in degrees.
struct CameraDescription {
  std::optional<glm::dvec3> position, lookAt, up;
  std::optional<double> verticalFov;         ///< above 0 and below 180; else 35
  std::optional<double> orthographicHeight;  ///< above 0; makes the projection orthographic
  std::optional<glm::dvec2> orbit;  ///< azimuth and elevation of the eye around the content; else kDefaultAzimuth and -Elevation
  /// A file, or JSON that begins with {, of key frames (flight_description.h) that take the place of all of the above.
  std::optional<std::string> flight;
  glm::ivec2 size{1024, 1024};      ///< pixels, 1 to kMaxImageEdge each
  std::optional<int> frames;        ///< of a turn, 1 to kMaximumFrames; else kDefaultFrames
  std::optional<std::string> holdout;  ///< an .exr of the depths of surfaces that this camera sees in front (readHoldout)

  /// Gives everything but the size, the frames and the holdout as this camera has it, in place of a flight as well.
  void look(const Camera& from);
  /// Reads the holdout; null if there is none. Fails with ErrorKind::Input, and unless it has the size of the image.
  std::shared_ptr<const Holdout> readHoldout() const;
  /// Fails for a camera that is wrong for every volume, and as readFlight().
  void check() const;
  /// The direction of the eye around the content.
  glm::dvec2 angles() const;
  /// The cameras of a flight (flightViews); else those of a full turn in equal steps about the axis through the look-at point along `up`.
  /// What is not given is chosen so that the content fills the image, from one distance for all frames, upright as the volume says.
  /// `content` is asked for if it is needed.
  std::vector<Camera> resolve(const Volume& volume, const std::function<Subject()>& content, int frameCount) const;

  bool operator==(const CameraDescription&) const = default;
};

struct ClassificationDescription {
  std::optional<double> densityScale;           ///< extinction per world unit at density 1, at least 0
  std::optional<glm::dvec3> albedo;             ///< linear Rec.709, 0 to 1
  std::optional<std::string> transferFunction;  ///< a file, a preset, or JSON that begins with { (transfer_source.h)
  /// Replaces the range of the transfer function; of a volume that has none, the function is then kFunctionOfWindow.
  std::optional<ValueWindow> window;
  std::optional<double> opacity;  ///< factor of the extinction, kMinOpacity to kMostOpacity
  bool invert = false;            ///< turns the colours of the transfer function round
  /// A grid of vectors of an OpenVDB file: linear colours, 0 to 1; kNone for none; else that of a usual name (grid_names.h), if there is
  /// one and neither albedo nor transfer function are given.
  std::optional<std::string> albedoGrid;
  std::optional<IsoSurface> iso;                ///< in place of a transfer function
  std::optional<ClassificationOrder> order;     ///< of a transfer function; else Post
  /// How labels are drawn, which the values then are. Else whole numbers, booleans and masks of an OpenVDB file are labels, all of which
  /// are drawn, unless another field of the classification is given.
  std::optional<Labels> labels;
  /// Grids that are drawn together in place of one, each with its colour; none: a single grid.
  std::vector<ChannelStyle> channels;

  /// Reads the transfer function. What is not given is as the volume's file says, if it does (Volume::classification); fields are
  /// refused where that is fixed. Otherwise, without any field, scans have scanTransferFunction, level sets are opaque, and others
  /// have the automatic density scale of volumes that shine, or do not.
  Classification resolve(const Volume& volume, bool shines) const;
  /// What values are projected by: the transfer function that is given or baked, else intensityFunction(), whatever the other fields say.
  /// Fails for isosurfaces, labels and channels, and for a baked volume without values.
  Classification resolveProjected(const Volume& volume, IntensityProjection projection) const;
  /// What slices are coloured by: the transfer function that is given or baked, else kFunctionOfWindow; none of labels and channels.
  /// Fails for a baked volume without values.
  Classification resolveSliced(const Volume& volume) const;
  /// Gives what was resolved for another volume.
  void take(const Classification& resolved);
  /// Gives the resolved function, and with it what changes it.
  void takeFunction(const TransferFunction& resolved);
  /// Gives the resolved density scale, and with it the opacity.
  void takeDensityScale(double resolved);
  /// What changes the function.
  TransferChange change() const { return {.window = window, .opacity = opacity.value_or(1.0), .inverted = invert}; }

  /// The grid of albedos to read, if any.
  std::optional<GridRequest> grid() const;
  LabelRequest labelRequest() const;
  /// Fails for channels of a volume that has none.
  void check(const InputDescription& input) const;

  bool operator==(const ClassificationDescription&) const = default;
};

inline constexpr const char* kFunctionOfWindow = "grey";
inline constexpr double kMinOpacity = 1e-6, kMostOpacity = 1e6;

/// Emission by temperature.
struct EmissionDescription {
  std::optional<bool> emission;    ///< whether hot voxels send out light; else they do where some are hot enough
  std::optional<double> strength;  ///< luminance per world unit at kReferenceTemperature, at least 0
  std::optional<std::string> temperatureGrid;  ///< of an OpenVDB file; turns emission on by itself
  std::optional<double> temperatureScale, temperatureOffset;  ///< kelvin = scale (at least 0) x value + offset

  /// Fails for fields that do not apply to the volume.
  void check(const InputDescription& input) const;
  /// Whether emission is asked for, so that a volume without temperatures is an error.
  bool isAsked() const { return emission.value_or(temperatureGrid || temperatureScale || temperatureOffset); }
  /// The grid to read; nothing without emission.
  std::optional<GridRequest> grid() const;
  /// Whether temperatures may be those of a fire, or emission is asked for.
  bool mayShine(const TemperatureGrid& grid) const;
  /// How temperatures of this range become light; the strength is 1 if it is not given.
  Emission scales(const TemperatureGrid& grid) const;
  /// Whether the volume sends out light: where that is not asked for, if it has temperatures that do.
  bool shines(const Volume& volume) const;
  /// What is not given is automatic. `classification` is that without emission.
  std::optional<Emission> resolve(const Volume& volume, const Classification& classification) const;
  /// Gives what was resolved for another volume.
  void take(const Emission& resolved);

  bool operator==(const EmissionDescription&) const = default;
};

/// A volume besides that of `input`: how it looks is its own, but what lights do with surfaces (Shading).
struct AddedVolume {
  InputDescription input;
  ClassificationDescription classification;
  EmissionDescription emission;
  std::optional<Shading> shading;       ///< else LightingDescription::shading
  std::optional<glm::dmat4> transform;  ///< from where the file has it in the world to where it is

  bool operator==(const AddedVolume&) const = default;
};

/// The method of drawing, in which the paper and FreeVoxels differ. What is not given is the default of FreeVoxels, or the paper's.
struct MethodDescription {
  std::optional<IntensityProjection> mode;  ///< else None: a ray sees a medium. The projections are without light
  std::optional<SlicePlane> slice;          ///< is drawn in place of a view, without light
  bool annotate = false;                    ///< whether the bars of annotation.h are drawn over the image
  bool paper = false;  ///< the paper's side of composite, attenuation, directions, code, path length, gradient, lod and culling
  std::optional<Draw> draw;  ///< else by drawing()
  std::optional<Composite> composite;
  std::optional<AttenuationLookup> attenuation;
  std::optional<DirectionSet> directions;
  std::optional<AttenuationCode> code;
  std::optional<bool> pathLengthCorrection, gradient;
  std::optional<double> lod;  ///< pixels, 0 to 10^6
  std::optional<double> quality;  ///< FrameSettings::quality, DraftQuality::kLeast to 1
  std::optional<bool> culling;
  std::optional<double> cullThreshold;  ///< transmittance, 0 to 1
  std::optional<HierarchyFilter> hierarchyFilter;

  TableSettings table() const;
  /// Whether `paper`, `attenuation` or another composite than Normalised is given.
  bool hasOptionsOfSplats() const;
  /// `draw`, or if it is not given Splats with options of theirs, else Gather.
  Draw drawing() const;
  bool isProjected() const { return mode.value_or(IntensityProjection::None) != IntensityProjection::None; }
  /// Whether values are shown, on which no light shines.
  bool showsValues() const { return isProjected() || slice; }
  /// Fails where gathering or a projection is asked for with options of splats, and for levels of detail of a projection.
  void apply(FrameSettings& frame) const;

  bool operator==(const MethodDescription&) const = default;
};

enum class PngBits : int { Eight = 0, Sixteen = 1 };

/// The form of the images.
struct OutputDescription {
  std::optional<glm::dvec3> background;  ///< of a .png or .jpg, linear, 0 to 1; else a dark gradient, unless `transparent`
  bool transparent = false;
  std::optional<double> exposure;  ///< stops by which a .png or .jpg is brightened, -20 to 20
  std::optional<ToneMap> toneMap;  ///< of a .png or .jpg; else None
  bool fullFloat = false;          ///< 32-bit floats in an .exr
  std::optional<PngBits> pngBits;  ///< bits a channel
  Aovs aovs;                       ///< of an .exr
  std::optional<PixelRectangle> crop;

  /// How a .png or a .jpg is made of an image.
  DisplayLook look() const;
  /// Fails where `crop` is not inside of an image of this size.
  void checkCrop(glm::ivec2 imageSize) const;

  bool operator==(const OutputDescription&) const = default;
};

/// What one of several frames of a scene shows.
struct FrameView {
  Camera camera;
  std::vector<Light> lights;  ///< in place of the scene's, which stay if there are none
};

/// A resolved description: what images are drawn of.
struct Scene {
  std::shared_ptr<const Volume> volume;
  Classification classification;
  Camera camera;
  std::optional<Lighting> lighting;
  std::vector<SceneVolume> added;  ///< the other volumes of the scene

  /// All volumes: `source` is that of `volume`.
  std::vector<SceneVolume> volumes(std::shared_ptr<const VolumeSource> source) const;
  /// Takes the camera of a frame and, unless it is unlit, its lights.
  void show(const FrameView& view);
};

/// What frames need of a baked file.
struct BakedNeed {
  int level = 0;
  bool isRead = false;  ///< whether what is seen is known only from the values
  bool operator==(const BakedNeed&) const = default;
};

struct SceneDescription {
  InputDescription input;
  ClassificationDescription classification;
  EmissionDescription emission;
  CameraDescription camera;
  LightingDescription lighting;
  MethodDescription method;
  OutputDescription output;
  std::vector<AddedVolume> added;  ///< the volumes besides that of `input`

  /// The same scene of another volume.
  SceneDescription of(const std::string& volume) const;
  /// Fails for fields that are wrong for every volume and file of their kinds.
  void check() const;
  /// Reads the volume, with the grids that other fields need; of a baked one an octree level, which other volumes do not have. A frame of
  /// a film may lack grids.
  Volume readVolume(std::uint64_t maximumVoxels, int level = 0, const Progress& progress = {}, bool isFrame = false) const;
  /// What frames need of a baked file: a level one finer than the finest of which anything is drawn, 0 where the levels are of scalars that
  /// are classified by a transfer function; and values beforehand where it is classified otherwise than when it was baked.
  BakedNeed needOf(const fvx::FvxFile& file, int frameCount) const;
  /// What frames are drawn of. A baked file is read by whoever draws it, where `mayStayFile` allows that and needOf(); other volumes
  /// are read, with at most kMaxNumberedVoxels that are occupied. A frame of a film may lack grids. Fails as readVolume().
  std::shared_ptr<const VolumeSource> openSource(int frameCount, bool mayStayFile = true, bool isFrame = false,
                                                 const Progress& progress = {}) const;
  /// As CameraDescription::resolve, of all volumes.
  std::vector<Camera> cameras(const Volume& volume, const Classification& classification, int frameCount = 1,
                              std::span<const SceneVolume> others = {}) const;
  std::vector<Camera> cameras(const Scene& scene, int frameCount = 1) const {
    return cameras(*scene.volume, scene.classification, frameCount, scene.added);
  }
  /// What each frame of a turn or a flight shows: the same cameras, and the lights of a flight that moves them. The lights of the first
  /// frame are those of resolve().
  std::vector<FrameView> views(const Scene& scene, int frameCount) const;
  /// Reads the other files and resolves everything.
  Scene resolve(std::shared_ptr<const Volume> volume) const;
  /// The two parts of resolve(): classification, and camera and light. `scene` must have the other part.
  Classification resolveClassification(const Volume& volume) const;
  /// The light, of which projections and slices have none.
  std::optional<Lighting> resolveLighting(const Volume& volume, const Classification& classification, const Camera& camera) const;
  void resolveView(Scene& scene) const;
  /// As resolve(), but with the camera, the lights and the scales of densities and temperatures or the transfer function of another
  /// volume's scene, so that frames of one film fit together.
  Scene resolveLike(const Scene& other, std::shared_ptr<const Volume> volume) const;
  /// A description that gives everything as it was resolved, so that it does not depend on the volume's values or on defaults.
  SceneDescription resolved(const Scene& scene) const;
  /// The same for the turn of which `scene` has the first camera: the orbit stands in place of a position that was not given, since
  /// a turn has another distance than its first frame alone. A flight stays what it is.
  SceneDescription resolvedTurn(const Scene& scene, int frameCount) const;

  /// The channels that are drawn: those that are given, or those that a scan shows. Reads the scan's header.
  std::vector<ChannelStyle> shownChannels() const;

  bool operator==(const SceneDescription&) const = default;
};

/// The camera that sees the slice of a scene through the box of a volume (sliceCamera).
Camera sliceCameraOf(const SceneDescription& scene, const Volume& volume);

/// Fails for a slice, which is one image and has no turn.
void refuseTurnOfSlice(const SceneDescription& scene);

/// Whether an image of the scene is a sum over its channels: light that is scattered from one to another is none.
bool channelsAddUp(const SceneDescription& scene);
/// Fails for layers (Aovs::lights, Aovs::channels) of light or channels that the scene has not, or of light that is no sum over channels.
void checkLayers(const SceneDescription& scene, const Aovs& aovs);

/// A text of everything that a Renderer of the scene depends on, except for its volume and the transfer function of that: scenes with equal
/// text can share one that is reclassified.
std::string rendererText(const SceneDescription& description, const Scene& scene);

/// "128", or "2048x2048x512" of one that is no cube.
std::string resolutionText(glm::ivec3 dimensions);

/// NAME of "procedural:NAME"; nothing for a file.
std::optional<std::string> proceduralName(const std::string& input);

/// `level` of a baked volume, or, with a warning, the finest one that has at most `maximumVoxels` voxels (finestLevel) if that is coarser.
/// Fails as finestLevel does.
int levelThatFits(const fvx::FvxFile& file, int level, std::uint64_t maximumVoxels, std::vector<std::string>& warnings);

/// Calls makeProcedural, but fails with ErrorKind::OutOfMemory before allocating if the volume exceeds `maximumVoxels` or this
/// machine's memory.
Volume openProcedural(const std::string& name, std::optional<glm::ivec3> resolution, std::uint64_t maximumVoxels,
                      const Progress& progress = {});

/// What the user should know of a volume: its own warnings, NaN values, and negative values if the scalars are densities.
std::vector<std::string> warningsOf(const Volume& volume, bool scalarsAreDensities);
/// What is not drawn of the transfer functions that a description names (transferWarnings). Fails with ErrorKind::Input.
std::vector<std::string> functionWarnings(const SceneDescription& description);
/// What was assumed of a volume's file, and how to say otherwise, in one line; empty if nothing was.
std::string remarksOf(const Volume& volume);

}  // namespace freevoxels
