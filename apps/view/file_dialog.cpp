#include "apps/view/file_dialog.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <set>
#include <utility>

#include "apps/common/sequence.h"
#include "apps/view/keys.h"
#include "apps/view/opened_file.h"
#include "apps/view/ui_painter.h"
#include "apps/view/widgets.h"
#include "engine/core/error.h"
#include "engine/description/scene_description.h"
#include "engine/volume/procedural.h"
#include "engine/volume/scan_file.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFiles = 20000;       // that are listed
constexpr const char* kThisFolder = ".";       // the name of the entry that opens the folder itself
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

/// Whether a folder is opened like a file.
bool isOpenedFolder(const fs::path& folder) {
  return hasEnding(folder, {".zarr"});
}

bool containsIgnoringCase(const std::string& text, const std::string& part) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::ranges::search(text, part, same).begin() != text.end() || part.empty();
}

bool startsIgnoringCase(const std::string& text, const std::string& part) {
  return part.size() <= text.size() && containsIgnoringCase(text.substr(0, part.size()), part);
}

/// As much of a text as fits into a width, with "..." for what does not.
std::string shortened(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  std::size_t length = text.size();
  const auto isWithinCharacter = [&] { return (static_cast<unsigned char>(text[length]) & 0xc0u) == 0x80u; };  // of UTF-8
  while (length > 0 && (isWithinCharacter() || ImGui::CalcTextSize((text.substr(0, length) + "...").c_str()).x > width)) --length;
  return text.substr(0, length) + "...";
}

/// How many files of a folder are the slices of volumes, which open by its name: TIFF and DICOM, of which the latter often have no ending.
std::size_t slicesAmong(const std::vector<fs::path>& files) {
  constexpr std::ptrdiff_t kTried = 3;  // of files whose endings say nothing
  const auto slices = std::ranges::count_if(files, [](const fs::path& file) { return hasEnding(file, {".tif", ".tiff", ".dcm", ".ima"}); });
  if (slices > 0) return std::size_t(slices);
  std::vector<fs::path> unknown;
  std::ranges::copy_if(files, std::back_inserter(unknown), [](const fs::path& file) { return !hasScanEnding(file); });
  return std::ranges::any_of(unknown.begin(), unknown.begin() + std::min(kTried, std::ssize(unknown)), isScanFile) ? unknown.size() : 0;
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
  const bool isFirst = !std::exchange(hasBegun_, true),
             hasFile = std::ranges::any_of(entries_, [](const Entry&entry) { return !entry.isFolder(); });
  const auto last = std::ranges::find_if(store_.recent(), [](const std::string& file) { return !proceduralName(file); });
  std::error_code unknown;
  if (isFirst && !hasFile && last != store_.recent().end() && fs::is_directory(fs::path(*last).parent_path(), unknown))
    go(fs::path(*last).parent_path());
}

void FileDialog::go(fs::path folder) {
  problem_.clear();
  typed_.clear();
  showsRecent_ = false;
  std::vector<Entry> folders;
  std::vector<fs::directory_entry> files;
  std::vector<fs::path> all;
  std::size_t hidden = 0;
  std::error_code problem;
  for (fs::directory_iterator at(folder, problem), end; !problem && at != end && files.size() < kMaxFiles; at.increment(problem)) {
    std::error_code unknown;
    if (at->path().filename().string().starts_with('.')) continue;
    if (at->is_directory(unknown) && !isOpenedFolder(at->path()))
      folders.push_back({.name = at->path().filename().string() + "/", .shown = at->path().filename().string() + "/"});
    else if (all_ || hasEnding(at->path(), endings_))
      files.push_back(*at);
    else
      ++hidden;
    if (at->is_regular_file(unknown)) all.push_back(at->path());
  }
  if (problem) {
    problem_ = fmt::format("cannot read the folder '{}': {}", folder.string(), problem.message());
    return;
  }
  // Without the slash that the name of a chosen folder ends in.
  folder_ = folder.has_filename() || !folder.has_relative_path() ? std::move(folder) : folder.parent_path();
  hidden_ = hidden;
  entries_ = std::move(folders);
  slices_ = saves_ ? 0 : slicesAmong(all);
  if (slices_ > 1) entries_.push_back({.name = kThisFolder, .shown = fmt::format("This folder, as a volume of {} slices", slices_)});
  std::ranges::sort(files, {}, [](const fs::directory_entry& file) { return file.path(); });
  addFiles(files);
  sort();
}

/// The folder itself first, then folders, which have names alone, then files.
void FileDialog::sort() {
  const auto rank = [](const Entry& entry) { return entry.name == kThisFolder ? 0 : entry.isFolder() ? 1 : 2; };
  const auto isBefore = [&](const Entry& a, const Entry& b) {
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    const Entry &first = descends_ ? b : a, &second = descends_ ? a : b;
    if (!a.isFolder() && sortedBy_ == Column::Size && a.bytes != b.bytes) return first.bytes < second.bytes;
    if (!a.isFolder() && sortedBy_ == Column::Changed && a.time != b.time) return first.time < second.time;
    return first.name < second.name;
  };
  std::ranges::stable_sort(entries_, isBefore);
}

/// While one types a name to open, what does not contain it is left out.
bool FileDialog::isListed(const Entry& entry) const {
  return saves_ || containsIgnoringCase(entry.shown, typed_);
}

/// The name of the listed entry that is `step` after the one of this name, or the first or last.
std::string FileDialog::next(const std::string& name, int step) const {
  std::vector<const Entry*> listed;
  for (const Entry& entry : entries_)
    if (isListed(entry)) listed.push_back(&entry);
  if (listed.empty()) return name;
  const auto current = std::ranges::find(listed, name, &Entry::name);
  const auto count = int(listed.size());
  const int number = current == listed.end() ? (step > 0 ? 0 : count - 1) : std::clamp(int(current - listed.begin()) + step, 0, count - 1);
  return listed[std::size_t(number)]->name;
}

/// What all entries that begin with the name have in common.
std::string FileDialog::completed(const std::string& name) const {
  std::optional<std::string> common;
  for (const Entry& entry : entries_) {
    if (!startsIgnoringCase(entry.name, name)) continue;
    if (!common) common = entry.name;
    std::size_t same = 0;
    while (same < common->size() && same < entry.name.size() && (*common)[same] == entry.name[same]) ++same;
    common->resize(same);
  }
  return common && common->size() > name.size() ? *common : name;
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
  const std::string name = completes ? dialog.completed(text) : dialog.next(text, data->EventKey == ImGuiKey_UpArrow ? -1 : 1);
  if (completes) dialog.typed_ = name;
  data->DeleteChars(0, data->BufTextLen);
  data->InsertChars(0, name.c_str());
  return 0;
}

/// The frames of a sequence are one entry beside the files themselves.
void FileDialog::addFiles(const std::vector<fs::directory_entry>& files) {
  std::set<std::string> framesOfSome;
  for (const fs::directory_entry& file : files) {
    const std::string name = file.path().filename().string(), stem = stemOf(file.path());
    std::error_code unknown;
    const std::uintmax_t bytes = file.is_regular_file(unknown) ? file.file_size(unknown) : 0;
    const fs::file_time_type time = file.last_write_time(unknown);
    const bool isNumbered = !saves_ && mayBeFrame(file.path()) && !stem.empty() && std::isdigit(stem.back()) != 0;
    if (isNumbered && !framesOfSome.contains(file.path().string()))
      if (const std::optional<Sequence> sequence = sequenceAround(file.path().string())) {
        framesOfSome.insert(sequence->files.begin(), sequence->files.end());
        const std::string pattern = fs::path(sequence->pattern).filename().string();
        entries_.push_back(
            {.name = pattern, .shown = fmt::format("{}  ({} frames)", pattern, sequence->files.size()), .time = time});
      }
    entries_.push_back({.name = name, .shown = name, .bytes = bytes, .time = time});
  }
}

void FileDialog::confirm(const std::string& typed) {
  const std::string meant = meantFile(typed);
  if (meant.empty()) return;
  std::error_code unknown;
  if (!saves_ && proceduralName(meant)) {
    chosen_(meant);
    return ImGui::CloseCurrentPopup();
  }
  const bool isThisFolder = meant == kThisFolder && slices_ > 1;
  const fs::path path = isThisFolder ? folder_ : (folder_ / meant).lexically_normal();
  if (fs::is_directory(path, unknown) && !isThisFolder && (saves_ || !isOpenedFolder(path))) {
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
    sortedBy_ = Column(specs->Specs[0].ColumnIndex);
    descends_ = specs->Specs[0].SortDirection == ImGuiSortDirection_Descending;
    specs->SpecsDirty = false;
    sort();
  }
  std::string chosen;
  for (const Entry& entry : entries_) {
    if (!isListed(entry)) continue;
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
  if (entries_.empty() && hidden_ > 0) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("No file of a known kind; \"All files\" shows the other %zu.", hidden_);
  }
  followed_ = name_;
  ImGui::EndTable();
  if (!chosen.empty()) confirm(chosen);  // which may replace the entries
}

const Texture* FileDialog::thumbnail(const std::string& file) {
  const auto [found, isNew] = thumbnails_.try_emplace(file);
  const fs::path path = store_.thumbnail(file);
  std::error_code unknown;
  if (isNew && !path.empty() && fs::exists(path, unknown)) try {
      const Image image = readPng(path);
      found->second = std::make_unique<Texture>(device_, image.size, "thumbnail");
      found->second->upload(device_, srgbTexels(image, {.background = Background{}}));
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
