#pragma once
// Errors that the user is to read.

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "engine/core/error.h"

namespace freevoxels::test {

/// The error that `action` must throw; a test fails where it throws none.
template <typename Action>
Error errorOf(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return {ErrorKind::Internal, ""};
}

/// One sentence on one line that contains all of `parts`.
template <typename Action>
void expectRefusal(Action&& action, ErrorKind kind, std::initializer_list<std::string> parts) {
  const Error error = errorOf(action);
  const std::string sentence = error.what();
  EXPECT_EQ(error.kind(), kind) << sentence;
  EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
  for (const std::string& part : parts)
    EXPECT_NE(sentence.find(part), std::string::npos) << part << " in: " << sentence;
}

}  // namespace freevoxels::test
