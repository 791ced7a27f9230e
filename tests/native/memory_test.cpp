// A device that is out of memory: what is said of it must help.
#include <gtest/gtest.h>

#include "expect_error.h"
#include "gl/buffer.h"
#include "gl/context_thread.h"

namespace mesograin::gl {
namespace {

constexpr std::size_t more_than_any_device_has = std::size_t{1} << 46U;

TEST(Memory, AMeshThatIsTooLargeIsNotHelpedByASmallerPicture) {
  ContextThread::instance().run([] {
    test::expect_error([] { const Buffer buffer(nullptr, more_than_any_device_has); }, "draw fewer triangles");
  });
}

}  // namespace
}  // namespace mesograin::gl
