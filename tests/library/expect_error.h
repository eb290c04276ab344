#pragma once

#include <freevoxels/freevoxels.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace freevoxels {

/// An error's kind, a part of its sentence, and, unless that does not matter, the keys that it names.
template <typename Work>
void expectError(v1::ErrorKind kind, const std::string& part, const Work& work,
                 const std::optional<std::vector<std::string>>& parameters = std::vector<std::string>()) {
  try {
    work();
    ADD_FAILURE() << "no error, but expected: " << part;
  } catch (const v1::Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    if (parameters) {
      EXPECT_EQ(error.parameters(), *parameters) << error.what();
    }
  }
}

}  // namespace freevoxels
