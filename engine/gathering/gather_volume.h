#pragma once
// The gather's data of a volume: bricks of 8^3 blocks that are not empty; and in them, for the axis along
// which rays march, quads of neighbouring blocks with their extinction and the light that they send to the
// eye.

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <span>

#include "engine/attenuation/attenuation_table.h"
#include "engine/gathering/gather_bricks.h"
#include "engine/gathering/gather_stages.h"
#include "engine/lighting/scattering_solver.h"
#include "engine/octree/volume_builder.h"
#include "engine/splatting/frame_constants.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

class GatherVolume;
class LightPass;

/// What reaches a box from the lights of the volume of which it is a part.
struct SurroundingLight {
  glm::ivec3 dimensions{0};      ///< of the volume
  glm::ivec3 first{0};           ///< the box's first voxel in the volume
  /// Codes of depths towards a light, 16 bits a block, in the order of the box's bricks; those of brick 0 are 0.
  std::function<std::vector<std::uint16_t>(int light, const GatherVolume& box)> codes;
};

/// Another volume between a volume and its lights.
struct ShadowingVolume {
  const LightPass* lights;  ///< prepared for the frame
  bool scalars;             ///< whether its rays are swept through scalars
  glm::ivec3 dimensions;
  glm::dmat4 indexToWorld;
};

/// COMPUTE other_depths.comp, shade_blocks.comp and brick_quads.comp, for the first frame and for every frame whose light or
/// axes differ from those of the previous one. Belongs to one volume, which must outlive it.
class GatherVolume {
 public:
  /// Finds the bricks, around the cells `met` of 1 << shader::kSkipLevels voxels (metCells), and adds the time of that to `times`. The
  /// other arguments must outlive this object. With `surroundings`, lights at samples are those, and only voxels are read. Fails with
  /// ErrorKind::OutOfMemory.
  GatherVolume(const Device& device, const Classification& classification, const BuiltVolume& built, const Cells& met,
               std::vector<StageTime>& times, const SurroundingLight* surroundings = nullptr);
  /// Goes on with another transfer function, for which the classification and the built volume have changed, but not the codes of its
  /// scalars, and for which `met` is marked. What does not depend on the function is kept. Only without `surroundings`.
  void reclassify(const Cells& met, std::vector<StageTime>& times);

  /// The input of shading a frame. `lighting` and `lights` are null without lighting.
  struct Shading {
    const FrameConstants& frame;
    const AttenuationTable* table;  ///< null if no light needs it
    const Lighting* lighting;
    const LightPass* lights;   ///< prepared for the frame; null without lights
    const ScatteringSolver* scattered;  ///< solved for the frame, for the whole volume; null without such light
    std::array<bool, 3> axes;  ///< axes along which rays march
    std::uint64_t keptQuadBytes = 0;  ///< quads of other axes are kept for later frames up to so many bytes
    std::span<const ShadowingVolume> others = {};  ///< always the same ones
  };
  /// Whether light is evaluated at the samples: from the rays of few lights, and what was scattered before. With more lights, or with
  /// shadows from the table, shading is per voxel.
  static bool lightsSamples(const Lighting* lighting);
  /// Allocates what the frame needs. Fails with ErrorKind::OutOfMemory.
  void prepare(const Shading& shading);
  /// What was made for frames.
  struct State {
    std::uint32_t shadedLevels;  ///< a bit for each level
    GatherBricks::Made light, gradients;
    std::array<GatherBricks::Made, 3> quads, lightQuads;  ///< by axis
  };
  /// Records the shading of the blocks that the frame reads, except for those that are still valid, which then counts as made. Must be
  /// called after prepare() with the same arguments.
  void record(Commands& commands, const Shading& shading);
  State state() const;
  /// Goes back to the state before a record() whose commands were given up.
  void restore(const State& before);

  /// An array of quads in one or more pieces, with texels unless it is read in pieces.
  struct QuadStore {
    std::vector<Buffer> pieces;
    TexelView texels;
    std::uint64_t bytes() const;
    VkDeviceAddress address(std::uint32_t piece) const { return pieces[std::min<std::size_t>(piece, pieces.size() - 1)].address(); }
  };
  /// The quads of one axis.
  struct Quads {
    QuadStore medium, source, extra;
    std::array<QuadStore, shader::kMaxSampleLights> light;  ///< codes of light (lightCodes_)
    GatherBricks::Made made, lightMade;
    std::uint64_t bytes() const;
  };
  /// The blocks of each level that the last frame read as blocks; other levels are empty. For validation and tests. Waits.
  std::vector<GatherBlocks> downloadBlocks() const;
  /// The light of each level whose light the last frame read; other levels are empty. For validation and tests. Waits.
  std::vector<GatherLight> downloadLight() const;

  /// None without such light. Waits.
  std::optional<ScatteredField> downloadScattered() const { return hasScattered() ? std::optional(scattered_->download()) : std::nullopt; }

  const GatherBricks& bricks() const { return bricks_; }
  const Quads& quads(int axis) const { return quads_[std::size_t(axis)]; }
  /// Fills in the frame's constants of the volume: the units of stored values, and the levels that it reads.
  void describe(shader::GatherFrame& frame) const;
  /// Whether source terms depend on the direction to the eye.
  bool hasTowards() const { return lit_ && !viewDependent_; }
  /// Whether emission is added to the light of samples, apart from the source terms.
  bool hasEmissionApart() const { return isSampled_ && built_.volume.hasEmission(); }
  /// Whether blocks have their own source terms; otherwise all have the same albedo.
  bool hasColors() const;
  /// Whether voxels are classified after interpolation: quads of the finest level then hold codes of scalars.
  bool hasScalars() const;
  bool isLit() const { return lit_; }
  int sampleLights() const { return int(sampled_.size()); }
  /// Whether light is evaluated at samples.
  bool isSampled() const { return isSampled_; }
  bool hasScattered() const { return isSampled_ && scattered_ != nullptr; }
  /// Texels of the scattered light, where hasScattered().
  const TexelView& scatteredTexels() const { return scattered_->texels(); }
  bool hasFlux() const { return hasScattered() && scattered_->onDevice().moments > 1; }
  /// Whether the extinction of light differs between the colours, or from that of alpha.
  bool isTinted() const { return lighting_ && (lighting_->isTinted() || splitPhase(*lighting_).forward > 0.0); }
  /// Whether surfaces are lit at samples.
  bool hasSurfaces() const { return sampleLights() > 0 && lighting_->surface > 0.0; }
  /// Whether quads are read by address, in pieces of shader::kPieceBricksLog2, because a texel buffer or an allocation cannot hold all.
  bool inPieces() const { return inPieces_; }
  /// Packed gradients of blocks; arbitrary texels without surfaces, and if quads are in pieces.
  const TexelView& gradients() const { return gradientTexels_.handle() == VK_NULL_HANDLE ? bricks_.numberTexels() : gradientTexels_; }
  /// TransferTable::texels(); arbitrary texels without scalars.
  const TexelView& transferTable() const;

 private:
  static constexpr GatherBricks::Range kEmptyBrick{.level = 0, .first = 0, .end = 1};
  static constexpr const char *kLightCodes = "codes of light", *kGradients = "gradients of surfaces";

  void include(const Cells& met, std::vector<StageTime>& times);
  void enlarge();
  Buffer enlarged(const Buffer& buffer, GatherBricks::Made& made, std::uint64_t blockBytes, const char* name) const;
  void makeSources();
  void prepareSampled(const Shading* shading);
  void describeLights(shader::GatherFrame& frame) const;
  glm::dmat4 toMedium(const ScatteringSolver& scattered) const;
  void dropOtherAxes(const std::array<bool, 3>& axes, std::uint64_t most);
  void makeRoom(Quads& quads, const std::array<bool, 3>& axes);
  QuadStore makeStore(bool needed, std::uint64_t quadBytes, VkFormat format, const char* name) const;
  std::vector<glm::uvec2> downloadSources(int level, std::size_t count) const;
  void shade(Commands& commands, const Shading& shading, int level);
  void recordShading(Commands& commands, const Shading& shading);
  /// Whether the level's blocks have source terms. The colours of scalars without light come from the transfer function, and
  /// voxels without light, emission and colours of their own have the volume's.
  bool shadesLevel(int level) const;
  std::optional<shader::CodeBricks> scalarCodes(int level) const;
  void recordQuads(Commands& commands, int axis);
  void recordBricks(Commands& commands, int axis, const GatherBricks::Range& range, const std::optional<shader::CodeBricks>& codes,
                    const QuadStore& medium, bool colored);
  void dropLightCodes();
  void recordLightCodes(Commands& commands, const Shading& shading);
  void recordLightDepths(Commands& commands, const Shading& shading, const GatherBricks::Range& range);
  void recordShadows(Commands& commands, const Shading& shading, std::span<const GatherBricks::Range> ranges);
  void recordOtherDepths(Commands& commands, const ShadowingVolume& other, const Buffer& constants, const GatherBricks::Range& range);
  void recordLightQuads(Commands& commands, int axis);
  void recordGradients(Commands& commands);
  void viewGradients();

  const Device& device_;
  const Classification& classification_;
  const BuiltVolume& built_;
  const SurroundingLight* surroundings_;
  Pipeline shadePass_;
  Buffer frame_;  ///< shader::SetupFrame
  GatherBricks bricks_;
  std::uint32_t capacity_ = 0;  ///< bricks for which there is room in what is stored by brick
  bool inPieces_ = false;
  std::uint32_t bricksPerPiece_ = 0;
  Buffer sources_;  ///< by rank: packed source term, extinction as a half
  Buffer extras_;   ///< by rank: three signed normalised bytes, or packed emission
  std::array<Quads, 3> quads_;
  // What the source terms were made for:
  std::uint32_t shadedLevels_ = 0;  ///< a bit for each level
  std::uint32_t wantedLevels_ = 0;
  bool lit_ = false, viewDependent_ = false;
  double sourceUnit_ = 1.0;
  std::optional<Lighting> lighting_;
  std::vector<Light> sampled_;  ///< lights that are evaluated at samples
  bool isSampled_ = false;
  const ScatteringSolver* scattered_ = nullptr;
  std::uint64_t scatteredVersion_ = 0, sourceLightsVersion_ = 0;  ///< that the source terms were made for
  glm::dvec3 deltaScale_{1.0};          ///< factor of the extinction that is left, as what is scattered forwards goes on
  /// 16 bits a block, in bricks: sqrt(optical depth / kOpaqueDepth) towards each light.
  std::array<Buffer, shader::kMaxSampleLights> lightCodes_;
  std::vector<Buffer> others_;  ///< shader::OtherVolume of Shading::others
  GatherBricks::Made lightMade_;
  std::uint64_t lightVersion_ = 0;  ///< LightPass::version() of the codes
  Buffer gradients_;  ///< 4 bytes a block, in bricks; empty until surfaces are lit at samples
  TexelView gradientTexels_;  ///< of gradients_; if quads are in pieces of its first word
  GatherBricks::Made gradientsMade_;
};

}  // namespace freevoxels
