#!/usr/bin/env python3
"""Reads the interface of compiled shaders, so that C++ never repeats what GLSL says.

    reflect.py header NAME FILE.spv OUT.h       the code of a shader and its interface: freevoxels::Shader NAME (engine/vulkan/shader.h)
    reflect.py structs OUT.cpp FILE.spv...      a static_assert of the size of every struct that C++ and the shaders share

Layouts are read from the Offset and ArrayStride decorations; scalar block layout makes them those of C++.
"""
import re
import struct
import sys

# Opcodes, decorations and storage classes of the SPIR-V specification.
NAME, TYPE_INT, TYPE_FLOAT, TYPE_VECTOR, TYPE_MATRIX, TYPE_IMAGE, TYPE_SAMPLED_IMAGE = 5, 21, 22, 23, 24, 25, 27
TYPE_ARRAY, TYPE_RUNTIME_ARRAY, TYPE_STRUCT, TYPE_POINTER, CONSTANT, SPEC_CONSTANT, VARIABLE = 28, 29, 30, 32, 43, 50, 59
EXECUTION_MODE, DECORATE, MEMBER_DECORATE, EXECUTION_MODE_ID = 16, 71, 72, 331
LOCAL_SIZE, LOCAL_SIZE_ID = 17, 38
ARRAY_STRIDE, BINDING, OFFSET = 6, 33, 35
UNIFORM_CONSTANT, UNIFORM, PUSH_CONSTANT, STORAGE_BUFFER = 0, 2, 9, 12
BUFFER_DIMENSION, WITH_SAMPLER = 5, 1


class Module:
    def __init__(self, file):
        with open(file, "rb") as source:
            data = source.read()
        self.words = struct.unpack(f"<{len(data) // 4}I", data)
        self.names, self.types, self.constants, self.pointers = {}, {}, {}, {}
        self.bindings, self.strides, self.offsets, self.variables = {}, {}, {}, []
        self.workgroup = (1, 1, 1)
        modes = []
        at = 5
        while at < len(self.words):
            count, opcode = self.words[at] >> 16, self.words[at] & 0xFFFF
            self._instruction(opcode, self.words[at + 1 : at + count], modes)
            at += count
        for mode, sizes in modes:
            self.workgroup = sizes if mode == LOCAL_SIZE else tuple(self.constants[i] for i in sizes)

    def _instruction(self, opcode, words, modes):
        if opcode == NAME:
            text = struct.pack(f"<{len(words) - 1}I", *words[1:])
            self.names[words[0]] = text[: text.index(b"\0")].decode()
        elif opcode in (TYPE_INT, TYPE_FLOAT, TYPE_VECTOR, TYPE_MATRIX, TYPE_IMAGE, TYPE_SAMPLED_IMAGE, TYPE_ARRAY,
                        TYPE_RUNTIME_ARRAY, TYPE_STRUCT):
            self.types[words[0]] = (opcode, words[1:])
        elif opcode == TYPE_POINTER:
            self.pointers[words[0]] = words[2]
            self.types[words[0]] = (opcode, words[1:])
        elif opcode in (CONSTANT, SPEC_CONSTANT):
            self.constants[words[1]] = words[2]
        elif opcode == VARIABLE:
            self.variables.append((words[2], self.pointers[words[0]], words[1]))  # storage class, type, id
        elif opcode == DECORATE and words[1] == BINDING:
            self.bindings[words[0]] = words[2]
        elif opcode == DECORATE and words[1] == ARRAY_STRIDE:
            self.strides[words[0]] = words[2]
        elif opcode == MEMBER_DECORATE and words[2] == OFFSET:
            self.offsets[(words[0], words[1])] = words[3]
        elif opcode in (EXECUTION_MODE, EXECUTION_MODE_ID) and words[1] in (LOCAL_SIZE, LOCAL_SIZE_ID):
            modes.append((words[1], tuple(words[2:5])))

    def size(self, type_id):
        """Bytes of a value with scalar block layout; None if it has no fixed size or no layout."""
        opcode, words = self.types.get(type_id, (None, ()))
        if opcode in (TYPE_INT, TYPE_FLOAT):
            return words[0] // 8
        if opcode == TYPE_POINTER:  # of a buffer reference
            return 8
        if opcode in (TYPE_VECTOR, TYPE_MATRIX):
            part = self.size(words[0])  # None of booleans
            return None if part is None else part * words[1]
        if opcode == TYPE_ARRAY:
            return self.strides[type_id] * self.constants[words[1]] if type_id in self.strides else None
        if opcode == TYPE_STRUCT and words and all((type_id, i) in self.offsets for i in range(len(words))):
            last = self.size(words[-1])
            return None if last is None else self.offsets[(type_id, len(words) - 1)] + last
        return None

    def descriptor(self, storage, type_id):
        """The name of the VkDescriptorType that a variable takes."""
        opcode, words = self.types[type_id]
        if storage == STORAGE_BUFFER:
            return "STORAGE_BUFFER"
        if storage == UNIFORM:
            return "UNIFORM_BUFFER"
        sampled = opcode == TYPE_SAMPLED_IMAGE
        image = self.types[words[0]][1] if sampled else words
        if image[1] == BUFFER_DIMENSION:
            return "UNIFORM_TEXEL_BUFFER" if image[5] == WITH_SAMPLER else "STORAGE_TEXEL_BUFFER"
        if sampled:
            return "COMBINED_IMAGE_SAMPLER"
        return "SAMPLED_IMAGE" if image[5] == WITH_SAMPLER else "STORAGE_IMAGE"

    def descriptors(self):
        """The descriptor types of bindings 0, 1, 2, ..., of which several variables may share one; None where there is no such binding."""
        found = {}
        for storage, type_id, variable in self.variables:
            if variable in self.bindings:
                found.setdefault(self.bindings[variable], set()).add(self.descriptor(storage, type_id))
        for binding in range(max(found, default=-1) + 1):
            if len(found.get(binding, ())) > 1:
                raise SystemExit(f"binding {binding} has the types {sorted(found[binding])}: one is needed")
        return [next(iter(found.get(binding, ())), None) for binding in range(max(found, default=-1) + 1)]

    def push_bytes(self):
        return sum(self.size(type_id) for storage, type_id, _ in self.variables if storage == PUSH_CONSTANT)

    def structs(self):
        """Names and bytes of the structs that have a layout."""
        for type_id, (opcode, _) in self.types.items():
            name, size = self.names.get(type_id, ""), self.size(type_id)
            if opcode == TYPE_STRUCT and size is not None and re.fullmatch(r"[A-Z]\w*", name):
                yield name, size


def write_header(name, file, out):
    module = Module(file)
    types = ", ".join("VK_DESCRIPTOR_TYPE_" + kind if kind else "kNoBinding" for kind in module.descriptors())
    words = ",".join(map(str, module.words))
    with open(out, "w") as header:
        header.write(f"""#pragma once
// Made by shaders/reflect.py.
#include "engine/vulkan/shader.h"
namespace freevoxels::shaders {{
inline constexpr std::uint32_t {name}_words[] = {{{words}}};
inline constexpr std::array<VkDescriptorType, {len(module.descriptors())}> {name}_bindings{{{types}}};
inline constexpr Shader {name}{{.words = {name}_words,
  .name = "{name}",
  .bindings = {name}_bindings,
  .pushConstantBytes = {module.push_bytes()},
  .workgroup = {{{", ".join(map(str, module.workgroup))}}}}};
}}  // namespace freevoxels::shaders
""")


def write_structs(out, files):
    shared = {}
    with open(__file__.replace("reflect.py", "interface.h")) as first:
        declared = set(re.findall(r"^struct (\w+)", first.read(), re.MULTILINE))
    for other in ("display_interface.h", "frame_interface.h", "gather_interface.h", "ui_interface.h"):
        with open(__file__.replace("reflect.py", other)) as more:
            declared |= set(re.findall(r"^struct (\w+)", more.read(), re.MULTILINE))
    for file in files:
        for name, size in Module(file).structs():
            if name in declared and shared.setdefault(name, size) != size:
                raise SystemExit(f"the struct {name} has {shared[name]} bytes in one shader and {size} in {file}")
    missing = sorted(declared - set(shared))
    if missing:
        raise SystemExit(f"no shader has a layout of the shared structs {', '.join(missing)}")
    with open(out, "w") as source:
        source.write("// Made by shaders/reflect.py: the sizes of the shared structs, as the compiled shaders have them.\n")
        source.write('#include "shaders/display_interface.h"\n#include "shaders/gather_interface.h"\n#include "shaders/ui_interface.h"\n')
        for name, size in sorted(shared.items()):
            source.write(f"static_assert(sizeof(freevoxels::shader::{name}) == {size});\n")


if __name__ == "__main__":
    if sys.argv[1] == "header":
        write_header(*sys.argv[2:])
    else:
        write_structs(sys.argv[2], sys.argv[3:])
