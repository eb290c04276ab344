#pragma once
// Internal to scene_fields.cpp: how members of a scene description become texts and back.

#include <fmt/ranges.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/parameter.h"
#include "engine/description/scene_fields.h"
#include "engine/description/text_values.h"

namespace freevoxels::scene_field {

using Kind = SceneField::Kind;
using Texts = std::vector<std::string>;

inline std::string marked(const std::string& name) {
  return fmt::format("{}", Parameter(name));
}

/// How a value is read from text and written.
template <typename Value>
struct Codec {
  Kind kind = Kind::Value;
  std::string form;
  std::function<Value(const std::string& name, const std::string& text)> read;
  std::function<std::string(const Value&)> text;
};

inline std::string joined(const std::vector<double>& values, char separator) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(numberText(value));
  return fmt::format("{}", fmt::join(texts, std::string(1, separator)));
}

/// Conversions of types to and from lists of numbers.
inline std::vector<double> numbersOf(double v) { return {v}; }
inline std::vector<double> numbersOf(int v) { return {double(v)}; }
inline std::vector<double> numbersOf(glm::dvec2 v) { return {v.x, v.y}; }
inline std::vector<double> numbersOf(glm::ivec2 v) { return {double(v.x), double(v.y)}; }
inline std::vector<double> numbersOf(glm::dvec3 v) { return {v.x, v.y, v.z}; }
inline std::vector<double> numbersOf(glm::ivec3 v) { return {double(v.x), double(v.y), double(v.z)}; }
inline std::vector<double> numbersOf(const VoxelBox& box) {
  return {double(box.first.x), double(box.first.y), double(box.first.z), double(box.last.x), double(box.last.y), double(box.last.z)};
}
inline std::vector<double> numbersOf(const ClipPlane& plane) {
  return {plane.point.x, plane.point.y, plane.point.z, plane.normal.x, plane.normal.y, plane.normal.z};
}
inline std::vector<double> numbersOf(const PixelRectangle& part) {
  return {double(part.corner.x), double(part.corner.y), double(part.size.x), double(part.size.y)};
}
inline void assign(double& v, const std::vector<double>& n) { v = n[0]; }
inline void assign(int& v, const std::vector<double>& n) { v = int(n[0]); }
inline void assign(glm::dvec2& v, const std::vector<double>& n) { v = {n[0], n[1]}; }
inline void assign(glm::ivec2& v, const std::vector<double>& n) { v = {n[0], n[1]}; }
inline void assign(glm::dvec3& v, const std::vector<double>& n) { v = {n[0], n[1], n[2]}; }
inline void assign(glm::ivec3& v, const std::vector<double>& n) { v = {n[0], n[1], n[2]}; }
inline void assign(VoxelBox& v, const std::vector<double>& n) { v = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}}; }
inline void assign(ClipPlane& v, const std::vector<double>& n) { v = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}}; }
inline void assign(PixelRectangle& v, const std::vector<double>& n) { v = {{n[0], n[1]}, {n[2], n[3]}}; }

/// Numbers; whole ones for a type that holds these.
template <typename Value>
Codec<Value> numbers(NumberForm form) {
  form.count = numbersOf(Value{}).size();
  return {.form = form.form,
          .read = [form](const std::string& name, const std::string& text) mutable {
            form.name = name;
            Value value;
            assign(value, readNumbers(form, text));
            return value;
          },
          .text = [separator = form.separator](const Value& value) { return joined(numbersOf(value), separator); }};
}

/// A size: one number for equal ones.
template <typename Value>
Codec<Value> extent(const std::string& form, int maximum) {
  Codec<Value> codec =
      numbers<Value>({.form = form, .range = {1.0, double(maximum)}, .whole = true, .mayBeOne = true, .separator = 'x'});
  return codec;
}

template <typename Enum>
Codec<Enum> words(const Words<Enum>& choice) {
  return {.form = fmt::format("{}", fmt::join(choice.texts, "|")),
          .read = [&choice](const std::string& name, const std::string& text) { return choice.at(readWord(name, choice.texts, text)); },
          .text = [&choice](const Enum& value) { return choice.of(value); }};
}

inline Codec<std::string> text(Kind kind, const std::string& form) {
  return {.kind = kind,
          .form = form,
          .read = [](const std::string&, const std::string& given) { return given; },
          .text = [](const std::string& value) { return value; }};
}

inline Codec<bool> truth(Kind kind) {
  return {.kind = kind,
          .form = "",
          .read = [](const std::string&, const std::string& given) { return given != "false"; },
          .text = [](const bool& value) { return value ? "true" : "false"; }};
}

/// Adds the fields of a section, which are members of `Part`.
template <typename Part>
class Section {
 public:
  Section(std::vector<SceneField>& fields, std::string name, Part SceneDescription::*part)
      : fields_(fields), name_(std::move(name)), part_(part) {}

  /// A field with its own conversions from and to texts.
  SceneField& add(const std::string& name, Kind kind, const std::string& form, std::function<void(Part&, const Texts&)> read,
                  std::function<Texts(const Part&)> texts) {
    return fields_.emplace_back(SceneField{
        .section = name_,
        .name = name,
        .kind = kind,
        .form = form,
        .read = [part = part_, read](SceneDescription& description, const Texts& given) { read(description.*part, given); },
        .texts = [part = part_, texts](const SceneDescription& description) { return texts(description.*part); }});
  }
  template <typename Value>
  SceneField& add(const std::string& name, std::optional<Value> Part::*member, const Codec<Value>& codec) {
    return add(
        name, codec.kind, codec.form,
        [=](Part& part, const Texts& given) { part.*member = codec.read(marked(name), given.back()); },
        [=](const Part& part) { return part.*member ? Texts{codec.text(*(part.*member))} : Texts{}; });
  }
  /// A member that always has a value; a flag and a text count as given where they are not false or empty.
  template <typename Value>
  SceneField& add(const std::string& name, Value Part::*member, const Codec<Value>& codec) {
    return add(
        name, codec.kind, codec.form,
        [=](Part& part, const Texts& given) { part.*member = codec.read(marked(name), given.back()); },
        [=](const Part& part) {
          const std::string one = codec.text(part.*member);
          return one.empty() || (codec.kind == Kind::Flag && one == "false") ? Texts{} : Texts{one};
        });
  }

 private:
  std::vector<SceneField>& fields_;
  const std::string name_;
  Part SceneDescription::*const part_;
};

}  // namespace freevoxels::scene_field
