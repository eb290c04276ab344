#include "apps/common/film_scenes.h"

#include <filesystem>
#include <limits>
#include <utility>

#include "engine/core/error.h"
#include "engine/octree/volume_limits.h"

namespace freevoxels {

std::optional<FilmView> FilmScenes::survey(const Progress& progress) {
  if (!isSeenAsAWhole()) return std::nullopt;
  std::optional<FilmView> view = viewOfFilm(description_, inputs_, kMaxNumberedVoxels, progress);
  isSurveyed_ = hasReference_ = view.has_value();
  if (view) reference_ = view->scene;
  return view;
}

std::shared_ptr<const VolumeSource> FilmScenes::read(const std::string& input, int turn, const Progress& progress) const {
  return description_.of(input).openSource(turn, !isFilm(), isSurveyed_, progress);
}

Scene FilmScenes::resolve(const std::string& input, std::shared_ptr<const Volume> volume) {
  const SceneDescription description = description_.of(input);
  if (isFixed() && reference_) return description.resolveLike(*reference_, std::move(volume));
  reference_ = description.resolve(std::move(volume));
  hasReference_ = true;
  return *reference_;
}

std::string remarkOf(const FilmView& view) {
  const auto nameOf = [](const std::string& input) { return std::filesystem::path(input).filename().string(); };
  return fmt::format("camera and scales are those of the whole film, in which {} holds most{}", nameOf(view.largest),
                     view.brightest.empty() ? "" : fmt::format(" and {} shines most", nameOf(view.brightest)));
}

Image emptyImage(const FrameSettings& settings) {
  const std::size_t pixels = std::size_t(settings.size.x) * std::size_t(settings.size.y);
  Image image{.size = settings.size, .pixels = std::vector<glm::vec4>(pixels, glm::vec4(0.0f))};
  if (settings.depth) image.depth.assign(pixels, std::numeric_limits<float>::infinity());
  return image;
}

}  // namespace freevoxels
