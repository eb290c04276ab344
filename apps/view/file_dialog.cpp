#include "apps/view/file_dialog.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <set>
#include <span>
#include <utility>

#include "apps/common/sequence.h"
#include "apps/view/keys.h"
#include "apps/view/opened_file.h"
#include "apps/view/sample_images.h"
#include "apps/view/ui_painter.h"
#include "apps/view/widgets.h"
#include "engine/core/error.h"
#include "engine/description/scene_description.h"
#include "engine/image/decode_png.h"
#include "engine/volume/procedural.h"
#include "engine/volume/scan_file.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

constexpr double kSecondsOfDoubleClick = 0.8;  // more than ImGui has, which counts by frames: while an image is made they are slow

std::string sizeText(std::uintmax_t bytes) {
  if (bytes < 1024) return fmt::format("{} B", bytes);
  if (bytes < 1024 * 1024) return fmt::format("{:.0f} KiB", double(bytes) / 1024.0);
  return fmt::format("{:.1f} MiB", double(bytes) / (1024.0 * 1024.0));
}

std::string timeText(fs::file_time_type time) {
  const auto system = std::chrono::file_clock::to_sys(time);
  const std::time_t seconds = std::chrono::system_clock::to_time_t(std::chrono::time_point_cast<std::chrono::seconds>(system));
  std::tm local{};
  localtime_r(&seconds, &local);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%d %H:%M", &local);
  return text;
}

/// What can be opened.
std::vector<std::string> openedEndings() {
  std::vector<std::string> endings{".vdb", ".fvx", ".json", ".exr", ".hdr", ".vp", ".xml", ".itf", ".tfi", ".1dt", ".mrml"};
  endings.insert(endings.end(), scanEndings().begin(), scanEndings().end());
  return endings;
}

/// As much of a text as fits into a width, with "..." for what does not.
std::string shortened(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  std::size_t length = text.size();
  const auto isWithinCharacter = [&] { return (static_cast<unsigned char>(text[length]) & 0xc0u) == 0x80u; };  // of UTF-8
  while (length > 0 && (isWithinCharacter() || ImGui::CalcTextSize((text.substr(0, length) + "...").c_str()).x > width)) --length;
  return text.substr(0, length) + "...";
}

/// The image that was stored of an opened file; of a sample that was never opened, the one that is in the program.
std::optional<Image> thumbnailOf(const std::string& file, const fs::path& stored) {
  std::error_code unknown;
  if (!stored.empty() && fs::exists(stored, unknown)) return readPng(stored);
  const std::span<const unsigned char> sample = sampleImage(proceduralName(file).value_or(""));
  return sample.empty() ? std::nullopt : std::optional(decodePng(file, sample));
}

}  // namespace

FileDialog::FileDialog(const Device& device, const SessionStore& store)
    : device_(device), store_(store), start_(fs::current_path()), folder_(start_) {}

void FileDialog::open(std::function<void(const std::string&)> chosen) {
  begin("Open", openedEndings(), std::move(chosen));
  saves_ = false;
  name_.clear();
}

void FileDialog::save(const char* title, const std::string& name, std::vector<std::string> endings,
                      std::function<void(const std::string&)> chosen) {
  begin(title, std::move(endings), std::move(chosen));
  saves_ = true;
  name_ = name;
}

void FileDialog::begin(const char* title, std::vector<std::string> endings, std::function<void(const std::string&)> chosen) {
  title_ = title;
  endings_ = std::move(endings);
  chosen_ = std::move(chosen);
  asked_ = focus_ = true;
  showsRecent_ = false;
  thumbnails_.clear();
  go(folder_);
  // At first the folder of the last file, if the working folder has none.
  const bool isFirst = !std::exchange(hasBegun_, true);
  const auto last = std::ranges::find_if(store_.recent(), [](const std::string& file) { return !proceduralName(file); });
  std::error_code unknown;
  if (isFirst && !list_.hasFiles() && last != store_.recent().end() && fs::is_directory(fs::path(*last).parent_path(), unknown))
    go(fs::path(*last).parent_path());
}

void FileDialog::go(fs::path folder) {
  typed_.clear();
  showsRecent_ = false;
  problem_ = list_.read(folder, all_ ? std::vector<std::string>() : endings_, saves_);
  if (!problem_.empty()) return;
  // Without the slash that the name of a chosen folder ends in.
  folder_ = folder.has_filename() || !folder.has_relative_path() ? std::move(folder) : folder.parent_path();
}

/// Tab completes the name, arrows go through the list.
int FileDialog::followKeys(ImGuiInputTextCallbackData* data) {
  FileDialog& dialog = *static_cast<FileDialog*>(data->UserData);
  const std::string text(data->Buf, std::size_t(data->BufTextLen));  // name_ is the field's for now
  if (data->EventFlag == ImGuiInputTextFlags_CallbackEdit) {
    dialog.typed_ = text.find('/') == std::string::npos && !proceduralName(text) ? text : "";
    return 0;
  }
  const bool completes = data->EventFlag == ImGuiInputTextFlags_CallbackCompletion;
  const std::string name =
      completes ? dialog.list_.completed(text) : dialog.list_.next(dialog.typed_, text, data->EventKey == ImGuiKey_UpArrow ? -1 : 1);
  if (completes) dialog.typed_ = name;
  data->DeleteChars(0, data->BufTextLen);
  data->InsertChars(0, name.c_str());
  return 0;
}

void FileDialog::confirm(const std::string& typed) {
  const std::string meant = meantFile(typed);
  if (meant.empty()) return;
  std::error_code unknown;
  if (!saves_ && proceduralName(meant)) {
    chosen_(meant);
    return ImGui::CloseCurrentPopup();
  }
  const bool isThisFolder = meant == FolderList::kThisFolder && list_.isVolume();
  const fs::path path = isThisFolder ? folder_ : (folder_ / meant).lexically_normal();
  if (fs::is_directory(path, unknown) && !isThisFolder && (saves_ || !FolderList::isOpenedLikeAFile(path))) {
    go(path);
    if (problem_.empty() && !saves_) name_.clear();
    focus_ = true;
    return;
  }
  if (!saves_ && !isPattern(meant) && !fs::exists(path, unknown)) {
    problem_ = fmt::format("cannot read '{}': there is no such file; check its name", meant);
    focus_ = true;
    return;
  }
  const fs::path below = path.lexically_relative(start_);
  const bool isBelow = !below.empty() && *below.begin() != ".." && below != ".";
  ImGui::CloseCurrentPopup();
  chosen_(isBelow ? below.string() : path.string());
}

void FileDialog::drawPlaces() {
  const auto place = [&](const char* label, const fs::path& folder) {
    if (ImGui::Selectable(label, !showsRecent_ && folder == folder_)) go(folder);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", folder.c_str());
  };
  if (!saves_ && ImGui::Selectable("Recent, samples", showsRecent_)) showsRecent_ = true;
  place("Working folder", start_);
  if (const char* const home = std::getenv("HOME"); home != nullptr && *home == '/') place("Home", home);
  place("File system", "/");
  ImGui::Separator();
  std::set<fs::path> folders;
  for (const std::string& file : store_.recent())
    if (!proceduralName(file)) folders.insert(fs::path(file).parent_path());
  for (const fs::path& folder : folders) place(folder.filename().empty() ? "/" : folder.filename().c_str(), folder);
}

void FileDialog::drawList() {
  constexpr ImGuiTableFlags kFlags =
      ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_Sortable;
  if (!ImGui::BeginTable("files", 3, kFlags)) return;
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableSetupColumn("Name", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("Size");
  ImGui::TableSetupColumn("Changed");
  ImGui::TableHeadersRow();
  if (ImGuiTableSortSpecs* const specs = ImGui::TableGetSortSpecs(); specs != nullptr && specs->SpecsDirty && specs->SpecsCount > 0) {
    list_.sortBy(FolderList::Column(specs->Specs[0].ColumnIndex), specs->Specs[0].SortDirection == ImGuiSortDirection_Descending);
    specs->SpecsDirty = false;
  }
  std::string chosen;
  for (const FolderList::Entry& entry : list_.entries()) {
    if (!entry.contains(typed_)) continue;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    constexpr ImGuiSelectableFlags kRow = ImGuiSelectableFlags_SpanAllColumns;
    ImGui::PushID(entry.name.c_str());
    if (ImGui::Selectable("##row", entry.name == name_, kRow)) {
      const bool again = clicked_ == entry.name && ImGui::GetTime() - clickedAt_ < kSecondsOfDoubleClick;
      clicked_ = entry.name;
      clickedAt_ = ImGui::GetTime();
      if (!saves_ || !entry.isFolder()) name_ = entry.name;  // the name of a file to save stays while one looks for its folder
      if (again) chosen = entry.name;
    }
    ImGui::PopID();
    if (entry.name == name_ && followed_ != name_) ImGui::SetScrollHereY();
    ImGui::SameLine(0.0f, 0.0f);
    ImGui::TextUnformatted(entry.shown.c_str());  // of a label, what follows the ## of a sequence's name would not be seen
    ImGui::TableNextColumn();
    if (!entry.isFolder() && entry.bytes > 0) ImGui::TextDisabled("%s", sizeText(entry.bytes).c_str());
    ImGui::TableNextColumn();
    if (!entry.isFolder()) ImGui::TextDisabled("%s", timeText(entry.time).c_str());
  }
  if (list_.entries().empty() && list_.hidden() > 0) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("No file of a known kind; \"All files\" shows the other %zu.", list_.hidden());
  }
  followed_ = name_;
  ImGui::EndTable();
  if (!chosen.empty()) confirm(chosen);  // which may replace the entries
}

const Texture* FileDialog::thumbnail(const std::string& file) {
  const auto [found, isNew] = thumbnails_.try_emplace(file);
  if (isNew) try {
      if (const std::optional<Image> image = thumbnailOf(file, store_.thumbnail(file))) {
        found->second = std::make_unique<Texture>(device_, image->size, "thumbnail");
        found->second->upload(device_, srgbTexels(*image, {.background = Background{}}));
      }
    } catch (const Error&) {
      found->second = nullptr;
    }
  return found->second.get();
}

/// A thumbnail with its name; true if it is clicked.
bool FileDialog::drawTile(const std::string& file, const std::string& label) {
  const float scale = ImGui::GetFontSize() / 15.0f;
  const ImVec2 size(scale * float(SessionStore::kThumbnailSize.x), scale * float(SessionStore::kThumbnailSize.y));
  ImGui::PushID(file.c_str());
  ImGui::BeginGroup();
  const ImVec2 low = ImGui::GetCursorScreenPos(), high(low.x + size.x, low.y + size.y);
  const bool clicked = ImGui::InvisibleButton("tile", {size.x, size.y + ImGui::GetTextLineHeightWithSpacing()});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_FrameBg), 3.0f);
  if (const Texture* const image = thumbnail(file)) list.AddImage(textureId(*image), low, high);
  if (ImGui::IsItemHovered()) {
    list.AddRect(low, high, ImGui::GetColorU32(ImGuiCol_CheckMark), 3.0f, 0, 2.0f);
    ImGui::SetTooltip("%s", file.c_str());
  }
  list.PushClipRect(low, {high.x, high.y + ImGui::GetTextLineHeightWithSpacing()}, true);
  list.AddText({low.x, high.y + 2.0f}, ImGui::GetColorU32(ImGuiCol_Text), shortened(label, size.x).c_str());
  list.PopClipRect();
  ImGui::EndGroup();
  ImGui::PopID();
  return clicked;
}

void FileDialog::drawRecent() {
  const float step = ImGui::GetFontSize() / 15.0f * float(SessionStore::kThumbnailSize.x) + ImGui::GetStyle().ItemSpacing.x;
  const int columns = std::max(int(ImGui::GetContentRegionAvail().x / step), 1);
  std::string chosen;
  int tile = 0;
  const auto draw = [&](const std::string& file, const std::string& label) {
    if (tile++ % columns != 0) ImGui::SameLine();
    if (drawTile(file, label)) chosen = file;
  };
  for (const std::string& file : store_.recent())
    if (!proceduralName(file)) draw(file, fs::path(file).filename().string());
  if (tile == 0) ImGui::TextDisabled("No file was opened yet.");
  ImGui::Spacing();
  ImGui::TextDisabled("Samples");
  tile = 0;
  for (const ProceduralKind& kind : proceduralKinds()) draw("procedural:" + std::string(kind.name), std::string(kind.name));
  if (!chosen.empty()) confirm(chosen);
}

void FileDialog::drawName() {
  std::error_code unknown;
  const std::string meant = meantFile(name_);
  const bool replaces = saves_ && !meant.empty() && fs::is_regular_file(folder_ / meant, unknown);
  ImGui::SetNextItemWidth(-1.0f);
  if (focus_ || !ImGui::IsAnyItemActive()) ImGui::SetKeyboardFocusHere();  // what is typed is a name
  focus_ = false;
  const bool entered = ImGui::InputTextWithHint("##name", saves_ ? "" : "a file, a folder, smoke_####.vdb or procedural:cloud", &name_,
                                                ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll |
                                                    ImGuiInputTextFlags_CallbackCompletion | ImGuiInputTextFlags_CallbackHistory |
                                                    ImGuiInputTextFlags_CallbackEdit,
                                                followKeys, this);
  if (!problem_.empty())
    drawSentence(problem_, false);
  else if (replaces)
    drawSentence("A file of this name exists and is replaced.", false);
  else
    ImGui::TextUnformatted("");
  bool sure = ImGui::Button(!saves_ ? "Open" : replaces ? "Replace" : "Save", {6.0f * ImGui::GetFontSize(), 0.0f});
  ImGui::SameLine();
  if (ImGui::Button("Cancel", {6.0f * ImGui::GetFontSize(), 0.0f}) || isKeyPressed(GLFW_KEY_ESCAPE))
    ImGui::CloseCurrentPopup();
  ImGui::SameLine();
  if (checkBox("All files", &all_)) go(folder_);
  if (entered || sure) confirm(name_);
}

void FileDialog::draw() {
  if (asked_) ImGui::OpenPopup("files");
  asked_ = false;
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const float text = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.5f * display.x, 0.5f * display.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(54.0f * text, display.x), std::min(34.0f * text, display.y)});
  isOpen_ = ImGui::BeginPopupModal("files", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize);
  if (!isOpen_) return;
  ImGui::TextUnformatted(title_.c_str());
  ImGui::SameLine();
  ImGui::TextDisabled("%s", folder_.c_str());
  ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize("Up").x - 2.0f * ImGui::GetStyle().FramePadding.x);
  if (ImGui::SmallButton("Up") && folder_.has_parent_path()) go(folder_.parent_path());
  const float below = 2.0f * ImGui::GetFrameHeightWithSpacing() + ImGui::GetTextLineHeightWithSpacing();
  ImGui::BeginChild("places", {10.0f * text, -below});
  drawPlaces();
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("list", {0.0f, -below});
  if (showsRecent_)
    drawRecent();
  else
    drawList();
  ImGui::EndChild();
  drawName();
  ImGui::EndPopup();
}

}  // namespace freevoxels
