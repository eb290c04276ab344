// Descriptions and provenances of files whose checksums are right.

#include "tests/storage/edited_fvx.h"

namespace freevoxels {
namespace {

using fvx::FvxFile;
using fvx::SectionKind;
using test::FvxEditor;

class FvxDescription : public test::EditedFvx {};

/// A key of the description, as a JSON pointer, and values that it cannot have.
struct BadValues {
  const char* key;
  std::vector<nlohmann::json> values;
};

TEST_F(FvxDescription, DescriptionsThatCannotBeAreRefusedInOneSentence) {
  const nlohmann::json number = 1e300, text = "text", none = nullptr, list = nlohmann::json::array(), half = 0.5;
  const std::vector<BadValues> bad{
      {"/dimensions/0", {0, -1, 67108865, number, half, text, none, 4294967297LL}},
      {"/dimensions", {list, text, {1, 2}, {1, 2, 3, 4}}},
      {"/index_origin/1", {2147483647, 4294967296LL, number, half, text}},
      {"/index_to_world/0", {0.0, 1e-300, number, text, none}},
      {"/index_to_world/3", {1.0, number, 1e-3}},
      {"/index_to_world/13", {1e30, -1e20, number}},
      {"/index_to_world/15", {0.0, 2.0, -1.0, half}},
      {"/index_to_world", {list, {1, 2, 3}}},
      {"/up/1", {0.0, number, text}},
      {"/active_voxels", {-1, 1 << 30, half, 0, text, none}},
      {"/nan_voxels", {-1, 1 << 30, half}},
      {"/negative_voxels", {-1, 1 << 30}},
      {"/minimum", {number, 1e6, text, none}},
      {"/maximum", {-number.get<double>(), -1e6, text, none}},
      {"/level_set", {1, text, none}},
      {"/source", {1, none, list}},
      {"/channels", {list, 1, text}},
      {"/channels/0/number", {-1, 1, half, text}},
      {"/channels/0/encoding", {"float64", 1, "\x1b[31m"}},
      {"/channels/0/scale", {-1.0, text, none}},
      {"/channels/0/offset", {number, text}},
      {"/classification/density_scale", {-1.0, text, none}},
      {"/classification/albedo/2", {-0.1, 1.5, number, text}},
      {"/classification/fixed", {1, none}},
      {"/classification/emission", {{{"strength", 1.0}}, {{"strength", -1.0}, {"temperature_scale", 1.0}, {"temperature_offset", 0.0}}}},
      {"/classification/transfer_function",
       {list,
        {{"unit_distance", 0.0}, {"opacity", {{0.0, 0.5}}}, {"color", {{0.0, 1.0, 1.0, 1.0}}}},
        {{"unit_distance", 1.0}, {"opacity", list}, {"color", {{0.0, 1.0, 1.0, 1.0}}}},
        {{"unit_distance", 1.0}, {"opacity", {{0.0, 1.5}}}, {"color", {{0.0, 1.0, 1.0, 1.0}}}},
        {{"unit_distance", 1.0}, {"opacity", {{1.0, 0.5}, {0.0, 0.5}}}, {"color", {{0.0, 1.0, 1.0, 1.0}}}},
        {{"unit_distance", 1.0}, {"opacity", {{1e300, 0.5}}}, {"color", {{0.0, 1.0, 1.0, 1.0}}}},
        {{"unit_distance", 1.0}, {"opacity", {{0.0, 0.5}}}, {"color", {{0.0, 1.0, 1.0}}}}}},
      {"/temperature/minimum", {number, 1e6}},
      {"/temperature/active_voxels", {-1, 1 << 30, 0}},
      {"/temperature/nan_voxels", {-1, 1 << 30}},
      {"/albedo/clipped_voxels", {-1, half, text}},
      {"/albedo", {none, list}},
  };
  bake(test::volumeOfAllChannels());
  const nlohmann::json sound = nlohmann::json::parse(FvxEditor(bytes_).text(SectionKind::Description));
  for (const BadValues& bads : bad)
    for (const nlohmann::json& value : bads.values) {
      nlohmann::json changed = sound;
      changed[nlohmann::json::json_pointer(bads.key)] = value;
      if (std::string(bads.key) == "/classification/transfer_function") changed["classification"]["order"] = "pre";
      SCOPED_TRACE(fmt::format("{} {}", bads.key, value.dump(-1, ' ', true)));
      FvxEditor edited(bytes_);
      edited.setText(SectionKind::Description, changed.dump());
      expectRefused(edited);
    }
  for (const auto& [key, value] : sound.items()) {
    nlohmann::json changed = sound;
    changed.erase(key);
    FvxEditor edited(bytes_);
    edited.setText(SectionKind::Description, changed.dump());
    SCOPED_TRACE(key);
    expectRefused(edited);
  }
  FvxEditor same(bytes_);
  same.setText(SectionKind::Description, sound.dump(2));
  same.save(file_);
  readAll();
}

TEST_F(FvxDescription, NamesInADescriptionBecomePrintable) {
  bake(test::volumeOfAllChannels());
  FvxEditor edited(bytes_);
  nlohmann::json json = nlohmann::json::parse(edited.text(SectionKind::Description));
  for (const char* key : {"/source", "/up_reason", "/temperature/name", "/albedo/name"})
    json[nlohmann::json::json_pointer(key)] = "\x1b[31m\x01grid\x02\x03 \u202e" + std::string(1000, 'x');
  edited.setText(SectionKind::Description, json.dump());
  edited.save(file_);
  const Volume volume = FvxFile(file_).description().volume;
  for (const std::string& name : {volume.source, volume.upReason, volume.temperature->name, volume.albedo->name}) {
    EXPECT_TRUE(name.starts_with("\\x1b[31m\\x01grid")) << name;
    EXPECT_LT(name.size(), 300u);
  }
}

TEST_F(FvxDescription, DescriptionsThatAreNoJsonAndDescriptionsAndProvenancesThatAreTooDeepAreRefused) {
  bake(test::smoothVolume());
  const auto expectRefusedWith = [&](SectionKind kind, const std::string& text) {
    FvxEditor edited(bytes_);
    edited.setText(kind, text);
    expectRefused(edited);
  };
  for (const SectionKind kind : {SectionKind::Description, SectionKind::Provenance})
    for (const std::size_t depth : {std::size_t(65), std::size_t(66), std::size_t(1000), std::size_t(100000)}) {
      const std::string list = std::string(depth, '[') + "0" + std::string(depth, ']');
      for (const std::string& text : {list, "{\"a\":" + list + "}", std::string(depth + 1, '['), "[" + list + ",\x1b"}) expectRefusedWith(kind, text);
    }
  for (const char* text : {"", "{", "[[[", "\xff", "{\"a\": \"\x1b\"}"}) expectRefusedWith(SectionKind::Description, text);
}

TEST_F(FvxDescription, AProvenanceMayBeAnyText) {
  bake(test::smoothVolume());
  for (const std::string& text : {std::string(), std::string("{"), std::string("\xff\x1b[31m"), std::string("{\"a\": \"\x1b\n\"}"),
                                 std::string(64, '[') + std::string(64, ']')}) {
    FvxEditor edited(bytes_);
    edited.setText(SectionKind::Provenance, text);
    edited.save(file_);
    EXPECT_EQ(FvxFile(file_).provenance(), text);
    readAll();
  }
}

}  // namespace
}  // namespace freevoxels
