// Which walks are kept: those asked for last, and few of bodies that are gone.
#include "transport/walks_shelf.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "shapes.h"

namespace mesograin::transport {
namespace {

class WalksShelfTest : public testing::Test {
 protected:
  std::shared_ptr<Walks> traced() const {
    auto walks = std::make_shared<Walks>(body_, Interface(1.3),
                                         Quality{.nodes = 60, .light_across = 4, .way_across = 4}, effort_);
    walks->trace({1.0}, effort_);
    return walks;
  }

  /// Puts walks that nobody else holds; `count` of them, of bodies 0, 1 ...
  void put(WalksShelf& shelf, int count) const {
    for (int i = 0; i < count; ++i) shelf.put(std::to_string(i), "fine", traced());
  }

  /// The bodies whose walks are still there. Looked for oldest first, the order of use stays what it was.
  static std::string kept(WalksShelf& shelf, int count) {
    std::string bodies;
    for (int i = 0; i < count; ++i)
      if (shelf.find(std::to_string(i), "fine")) bodies += std::to_string(i);
    return bodies;
  }

  static bool all(const std::string&) { return true; }
  static bool none(const std::string&) { return false; }

  Effort effort_;
  std::shared_ptr<const Body> body_ = std::make_shared<const Body>(cube(), glm::dmat3(1.0));
  std::size_t bytes_ = traced()->bytes();
};

TEST_F(WalksShelfTest, KeepsWhatWasAskedForLast) {
  ASSERT_GT(bytes_, 0U);
  WalksShelf shelf(3 * bytes_, 3 * bytes_);
  put(shelf, 5);
  EXPECT_FALSE(shelf.find("1", "coarse"));
  ASSERT_TRUE(shelf.find("1", "fine"));
  EXPECT_EQ(shelf.bytes(), 5 * bytes_);
  shelf.trim(all);
  EXPECT_EQ(shelf.bytes(), 3 * bytes_);
  EXPECT_EQ(kept(shelf, 5), "134");
}

TEST_F(WalksShelfTest, KeepsFewOfBodiesThatAreGone) {
  WalksShelf shelf(10 * bytes_, 2 * bytes_);
  put(shelf, 5);
  shelf.trim(all);
  EXPECT_EQ(kept(shelf, 5), "01234");
  shelf.trim(none);
  EXPECT_EQ(kept(shelf, 5), "34") << "an edit that is undone finds the newest again";
}

TEST_F(WalksShelfTest, BodiesThatAreGoneDoNotPushOutThoseInUse) {
  WalksShelf shelf(4 * bytes_, bytes_);
  put(shelf, 2);
  for (int i = 2; i < 7; ++i) {
    shelf.put(std::to_string(i), "fine", traced());
    shelf.trim([](const std::string& body) { return body < "2"; });
  }
  EXPECT_EQ(kept(shelf, 7), "016") << "the oldest are in use";
}

TEST_F(WalksShelfTest, KeepsTheLastWhateverItTakesWhileItIsInUse) {
  WalksShelf shelf(0, 0);
  put(shelf, 2);
  shelf.trim(all);
  EXPECT_EQ(kept(shelf, 2), "1");
  shelf.trim(none);
  EXPECT_EQ(kept(shelf, 2), "");
}

}  // namespace
}  // namespace mesograin::transport
