// Films.

#include <algorithm>
#include <mutex>

#include "apps/common/scene_sequence.h"
#include "apps/library/translation.h"

namespace freevoxels::v1 {

namespace {

/// Sentences that are told while frames are drawn, each once.
class Told {
 public:
  void add(std::string sentence) {
    const std::lock_guard lock(mutex_);
    if (std::ranges::find(sentences_, sentence) == sentences_.end()) sentences_.push_back(std::move(sentence));
  }
  std::vector<std::string> all() const {
    const std::lock_guard lock(mutex_);
    return sentences_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> sentences_;
};

}  // namespace

struct Sequence::State {
  State(const std::vector<std::string>& names, Json scene, std::shared_ptr<DeviceContext> context)
      : sequence(
            names, std::move(scene),
            [this](const std::string& sentence, bool isWarning) {
              (isWarning ? warnings : remarks).add(printable(withSceneKeys(sentence)));
            },
            std::move(context)) {}

  Told warnings, remarks;
  SceneSequence sequence;  // last, as it tells the others
};

Sequence::Sequence(const Context& context, const std::vector<std::string>& names, std::string_view scene)
    : state_(translated([&] { return std::make_unique<State>(names, parseScene(scene), context.state_->context); })) {}

Sequence::Sequence(const std::vector<std::string>& names, std::string_view scene)
    : state_(translated([&] { return std::make_unique<State>(names, parseScene(scene), nullptr); })) {}

Sequence::~Sequence() = default;
Sequence::Sequence(Sequence&&) noexcept = default;
Sequence& Sequence::operator=(Sequence&&) noexcept = default;

std::size_t Sequence::size() const {
  return state_->sequence.volumes().size();
}

std::vector<std::string> Sequence::files() const {
  std::vector<std::string> files;
  for (const NumberedVolume& volume : state_->sequence.volumes()) files.push_back(volume.file);
  return files;
}

std::vector<double> Sequence::numbers() const {
  std::vector<double> numbers;
  for (const NumberedVolume& volume : state_->sequence.volumes()) numbers.push_back(volume.number.value);
  return numbers;
}

Image Sequence::render(std::size_t frame, std::string_view scene, const FrameOptions& options) {
  return translated([&] {
    if (frame >= size()) fail(freevoxels::ErrorKind::Usage, "there is no frame {}: the sequence has {}, numbered from 0", frame, size());
    SceneSequence& sequence = state_->sequence;
    return imageOf(
        sequence.render(frame, *sequence.read(parseScene(scene), holdoutOf(options.holdout)), {.depth = options.depth}, options.progress));
  });
}

std::vector<std::string> Sequence::save(const std::vector<std::string>& images, std::string_view scene, bool skipExisting,
                                        const Progress& progress) {
  return translated([&] { return state_->sequence.save(images, parseScene(scene), skipExisting, progress); });
}

std::string Sequence::camera() const {
  return state_->sequence.camera().dump();
}

std::vector<std::pair<std::string, double>> Sequence::timings() const {
  return pairsOf(state_->sequence.timings());
}

std::string Sequence::device() const {
  return state_->sequence.context()->device->description().name;
}

std::vector<std::string> Sequence::warnings() const {
  return state_->warnings.all();
}

std::vector<std::string> Sequence::remarks() const {
  return state_->remarks.all();
}

}  // namespace freevoxels::v1
