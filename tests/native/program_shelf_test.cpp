// What is compiled stays while there is use for it, and does not grow for ever.
#include "render/program_shelf.h"

#include <gtest/gtest.h>

#include <string>

#include "gl/context_thread.h"

namespace mesograin::render {
namespace {

// A sample that needs the programs of these names; gives how many had to be compiled.
std::size_t draw(ProgramShelf& shelf, const std::vector<std::string>& names) {
  const std::size_t before = shelf.compiled();
  shelf.begin_sample();
  for (const std::string& name : names) {
    const gl::Program& program = shelf.find(
        name, {{GL_VERTEX_SHADER, gl::ShaderSource::from_text(name, "void main() { gl_Position = vec4(0.0); }\n", {})},
               {GL_FRAGMENT_SHADER, gl::ShaderSource::from_text(name, "void main() {}\n", {})}});
    EXPECT_EQ(program.name(), name);
  }
  return shelf.compiled() - before;
}

void rest(ProgramShelf& shelf) {
  for (std::uint64_t sample = 0; sample < ProgramShelf::in_use; ++sample) shelf.begin_sample();
}

class ProgramShelfTest : public testing::Test {
 protected:
  void TearDown() override { EXPECT_TRUE(gl::ContextThread::instance().take_gl_errors().empty()); }
};

TEST_F(ProgramShelfTest, TheLongestUnusedGoWhereThereAreMany) {
  gl::ContextThread::instance().run([] {
    ProgramShelf shelf(2);
    EXPECT_EQ(draw(shelf, {"a", "b"}), 2U);
    EXPECT_EQ(draw(shelf, {"a", "c"}), 1U);
    rest(shelf);
    EXPECT_EQ(shelf.freed(), 1U);
    EXPECT_EQ(draw(shelf, {"a", "c"}), 0U);
    EXPECT_EQ(draw(shelf, {"b"}), 1U);
  });
}

TEST_F(ProgramShelfTest, WhatIsInUseStaysHoweverManyTheseAre) {
  gl::ContextThread::instance().run([] {
    ProgramShelf shelf(2);
    const std::vector<std::string> one_view{"a", "b", "c"}, another{"d", "e", "f"};
    EXPECT_EQ(draw(shelf, one_view) + draw(shelf, another), 6U);
    for (std::uint64_t turn = 0; turn < ProgramShelf::in_use; ++turn)
      EXPECT_EQ(draw(shelf, one_view) + draw(shelf, another), 0U);
    rest(shelf);
    EXPECT_EQ(shelf.compiled() - shelf.freed(), 2U);
  });
}

TEST_F(ProgramShelfTest, ThereIsRoomForAllWhereThereAreFew) {
  gl::ContextThread::instance().run([] {
    ProgramShelf shelf(3);
    draw(shelf, {"a", "b", "c"});
    for (int round = 0; round < 3; ++round) rest(shelf);
    EXPECT_EQ(shelf.freed(), 0U);
  });
}

}  // namespace
}  // namespace mesograin::render
