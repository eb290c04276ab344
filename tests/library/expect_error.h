#pragma once

#include <freevoxels/freevoxels.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace freevoxels {

/// An error's kind and a part of its sentence. Returns the keys that it names.
template <typename Work>
std::vector<std::string> expectRefused(v1::ErrorKind kind, const std::string& part, const Work& work) {
  try {
    work();
    ADD_FAILURE() << "no error, but expected: " << part;
  } catch (const v1::Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    return error.parameters();
  }
  return {};
}

template <typename Work>
void expectError(v1::ErrorKind kind, const std::string& part, const Work& work, const std::vector<std::string>& parameters = {}) {
  EXPECT_EQ(expectRefused(kind, part, work), parameters) << part;
}

}  // namespace freevoxels
