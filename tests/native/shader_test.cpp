// Shader text: includes, messages that name file and line, uniforms known by name and type.
#include <gtest/gtest.h>

#include "expect_error.h"
#include "gl/context_thread.h"
#include "gl/program.h"
#include "gl/shader_library.h"
#include "gl/shader_source.h"

namespace mesograin::gl {
namespace {

using test::expect_error;

const std::string full_screen = "void main() { gl_Position = vec4(0.0); }\n";

Program make_program(const std::string& fragment) {
  return Program("test", ShaderSource::from_text("test.vert", full_screen, {}),
                 ShaderSource::from_text("test.frag", fragment, {}));
}

TEST(ShaderSource, EveryIncludeIsExpandedOnce) {
  const ShaderSource source({"passes/shade.frag", "models/lambert.glsl"}, {"CHOICE 1"});
  const std::string& text = source.text();
  EXPECT_EQ(text.find("#version 450 core\n#define CHOICE 1\n"), 0U);
  EXPECT_EQ(text.find("#include"), std::string::npos);
  const std::size_t first = text.find("struct SurfacePoint");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(text.find("struct SurfacePoint", first + 1), std::string::npos);
}

TEST(ShaderSource, AMissingFileIsNamedWithItsIncluder) {
  expect_error([] { ShaderSource source({"passes/no_such.frag"}, {}); }, "'passes/no_such.frag'");
  expect_error([] { ShaderSource::from_text("mine.frag", "#include \"lost.glsl\"\n", {}); }, "mine.frag includes");
}

TEST(ShaderSource, LibraryHoldsThePasses) {
  bool found = false;
  for (const ShaderFile& file : shader_files()) found = found || file.path == "passes/shade.frag";
  EXPECT_TRUE(found);
}

TEST(Program, ACompileErrorNamesProgramFileAndLine) {
  ContextThread::instance().run([] {
    expect_error([] { make_program("out vec4 colour;\n\nvoid main() {\n  colour = nonsense;\n}\n"); },
                 "The fragment shader of 'test' does not compile on this device: test.frag:4");
  });
}

TEST(Program, ALinkErrorNamesTheProgram) {
  ContextThread::instance().run([] {
    expect_error([] { make_program("vec4 lost();\nout vec4 colour;\nvoid main() { colour = lost(); }\n"); }, "'test'");
  });
}

TEST(Program, UniformsAreReflectedAndTyped) {
  ContextThread::instance().run([] {
    const Program program = make_program(
        "uniform vec3 tint;\nuniform float unused;\nout vec4 colour;\nvoid main() { colour = vec4(tint, 1.0); }\n");
    EXPECT_TRUE(program.has("tint"));
    EXPECT_FALSE(program.has("unused"));
    EXPECT_NO_THROW(program.set("tint", glm::vec3(1.0F)));
    EXPECT_NO_THROW(program.set("unused", 1.0F));
    EXPECT_THROW(program.set("tint", 1.0F), std::logic_error);
    EXPECT_THROW(program.set("tnit", glm::vec3(1.0F)), std::logic_error);
    EXPECT_NO_THROW(program.offer("tnit", glm::vec3(1.0F)));
    EXPECT_THROW(program.offer("tint", 1.0F), std::logic_error);
  });
  EXPECT_TRUE(ContextThread::instance().take_gl_errors().empty());
}

TEST(ContextThread, ErrorsOfPostedWorkReachTheCaller) {
  expect_error([] { ContextThread::instance().run([] { throw Error("What went wrong."); }); }, "What went wrong.");
}

TEST(ContextThread, GlErrorsAreCollectedOnce) {
  ContextThread::instance().run([] { glEnable(0xFFFF); });
  EXPECT_EQ(ContextThread::instance().take_gl_errors(), std::vector<std::string>{"GL_INVALID_ENUM"});
  EXPECT_TRUE(ContextThread::instance().take_gl_errors().empty());
}

TEST(ContextThread, DeviceInfoNamesTheRendererAndWhatWasTried) {
  const DeviceInfo& info = ContextThread::instance().device_info();
  EXPECT_FALSE(info.renderer.empty());
  EXPECT_NE(info.version.find("4.5"), std::string::npos);
  EXPECT_FALSE(info.tried.empty());
}

}  // namespace
}  // namespace mesograin::gl
