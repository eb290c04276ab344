#include "apps/view/shown_image.h"

#include <utility>

namespace freevoxels {

namespace {

constexpr std::chrono::milliseconds kFade{140};  // from a quick image to the whole one

void makeTexture(const Device& device, std::unique_ptr<Texture>& texture, glm::ivec2 size) {
  if (!texture || texture->size() != size) texture = std::make_unique<Texture>(device, size, "image");
}

}  // namespace

void ShownImage::show(std::shared_ptr<const DrawnImage> drawn, bool fades) {
  isNew_ = true;
  drawn_ = std::move(drawn);
  if (!devices_.areOne()) {
    moved_ = devices_.moved(*drawn_->shown);
    if (drawn_->compared) movedCompared_ = devices_.moved(*drawn_->compared);
  }
  before_ = nullptr;
  if (fades && texture_) {
    before_ = std::move(texture_);
    beforeIsOpaque_ = isOpaque_;
  }
  since_ = Clock::now();
  makeTexture(devices_.showing(), texture_, drawn_->shown->size());
  if (drawn_->compared)
    makeTexture(devices_.showing(), compared_, drawn_->compared->size());
  else
    compared_ = nullptr;
}

void ShownImage::record(Commands& commands, const DisplayLook& look) {
  if (!isNew_) return;
  isOpaque_ = look.background.has_value();
  display_.record(commands, devices_.areOne() ? *drawn_->shown : moved_, look, *texture_);
  if (compared_) display_.record(commands, devices_.areOne() ? *drawn_->compared : movedCompared_, look, *compared_);
}

void ShownImage::painted() {
  isNew_ = false;
  if (!fades()) before_ = nullptr;
}

bool ShownImage::fades() const {
  return before_ && Clock::now() - since_ < kFade;
}

ShownTextures ShownImage::textures() const {
  const std::chrono::duration<float> since = Clock::now() - since_;
  return {.image = texture_.get(),
          .before = fades() ? before_.get() : nullptr,
          .compared = compared_.get(),
          .weight = since / std::chrono::duration<float>(kFade),
          .isOpaque = isOpaque_ && (!fades() || beforeIsOpaque_)};
}

}  // namespace freevoxels
