#include "apps/common/scene_tools.h"

#include <exception>
#include <mutex>

#include "apps/common/keyword_options.h"
#include "apps/common/merge.h"
#include "apps/common/output_options.h"
#include "apps/common/program.h"
#include "apps/common/volume_info.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

using Json = nlohmann::json;

bool takeFlag(Json& keywords, const char* name) {
  const std::optional<Json> value = takeKey(keywords, name);
  if (value && !value->is_boolean()) fail(ErrorKind::Usage, "{} takes true or false", Parameter(name));
  return value && value->get<bool>();
}

BakeRequest requestOf(const std::string& file, Json keywords, const KeywordOptions::Sections& sections) {
  BakeRequest request{.file = file};
  request.keepScalars = takeFlag(keywords, "keep-scalars");
  request.compress = takeFlag(keywords, "compress");
  request.scene = KeywordOptions({keywords}, sections).scene;
  return request;
}

/// Runs work that may be abandoned by a caller's exception, which leaves it as it is: what writes a file would take it for the library's
/// that writes, and say that the file cannot be written.
template <typename Work>
void abandonable(const Progress& progress, const Work& work) {
  struct Abandoned {};  // of no class that anything catches
  if (!progress) return work(progress);
  std::exception_ptr thrown;
  std::mutex mutex;  // guards it, as threads that read call the function
  const Progress kept = [&](std::string_view stage, double fraction) {
    try {
      progress(stage, fraction);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!thrown) thrown = std::current_exception();
      throw Abandoned();
    }
  };
  try {
    work(kept);
  } catch (const Abandoned&) {
    std::rethrow_exception(thrown);
  }
}

/// The keywords with the name of a volume, unless that is empty.
Json withVolume(Json keywords, const std::string& volume) {
  if (!volume.empty()) keywords["volume"] = volume;
  return keywords;
}

}  // namespace

void bakeFile(const std::string& volume, const std::string& file, const Json& keywords, const BakeRemarks& remarks,
              const Progress& progress) {
  const BakeRequest request = requestOf(file, withVolume(keywords, volume), {"input", "classification", "emission", "scene"});
  if (request.scene.input.volume.empty())
    fail(ErrorKind::Usage, "there is no volume to bake: name a file or procedural:NAME, or give a scene with a {}", Parameter("volume"));
  checkBake(request);
  abandonable(progress, [&](const Progress& kept) { bakeScene(request, remarks, kept); });
}

void bakeShared(const SharedVolume& volume, const std::string& file, const Json& keywords, const Progress& progress) {
  const BakeRequest request = requestOf(file, keywords, {"classification", "emission", "scene"});
  checkBake(request);
  abandonable(progress, [&](const Progress& kept) {
    bakeInMemory(request, *volume.source({.level = 0, .isRead = true}, kept)->whole(kept), kept);
  });
}

void convertFile(const std::string& volume, const std::string& file, const Json& keywords, const ConvertRemarks& remarks,
                 const Progress& progress) {
  const InputDescription input = KeywordOptions({withVolume(keywords, volume)}, {"input", "scene"}).scene.input;
  if (input.volume.empty()) fail(ErrorKind::Usage, "there is no volume to convert: name a file or procedural:NAME");
  checkConvert(input, file);
  abandonable(progress, [&](const Progress& kept) { convertVolume(input, file, remarks, kept); });
}

nlohmann::ordered_json infoOf(const std::string& volume, const Json& keywords) {
  Json given = withVolume(keywords, volume);
  const bool check = takeFlag(given, "check");
  const InputDescription input = KeywordOptions({given}, {"input", "scene"}).scene.input;
  if (input.volume.empty()) fail(ErrorKind::Usage, "there is no volume to describe: name a file or procedural:NAME");
  return volumeInfo(input, check);
}

void mergeFiles(std::span<const std::string> parts, std::span<const std::string> images, const Json& keywords) {
  const OutputDescription output = KeywordOptions({keywords}, {"output"}).scene.output;
  std::vector<std::string> files(parts.begin(), parts.end());
  files.insert(files.end(), images.begin(), images.end());
  checkDistinct(files);
  if (parts.empty() || images.empty()) fail(ErrorKind::Usage, "there is nothing to merge: name files of sums, and images to write");
  for (const std::string& part : parts)
    if (!isPartOfImage(part))
      fail(ErrorKind::Usage, "'{}' is no file of sums: name the files that 'freevoxels render --share I/N --sums' wrote", part);
  if (usesStandardOutput(images)) fail(ErrorKind::Usage, "'-' is standard output, where the command line alone writes: name a file");
  checkOutputs(output, images);
  mergeParts(parts, output, images);
}

}  // namespace freevoxels
