// A user's mistake must end in one sentence that names what matters.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"

namespace mesograin::test {

/// Expects Error from `action` whose sentence holds `part`, on one line and ended by a full stop.
template <typename Action>
void expect_error(Action action, const std::string& part) {
  try {
    action();
  } catch (const Error& error) {
    const std::string sentence = error.what();
    EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
    EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
    EXPECT_EQ(sentence.back(), '.') << sentence;
    return;
  }
  ADD_FAILURE() << "no Error came; one with '" << part << "' was expected";
}

}  // namespace mesograin::test
