// Transport that is computed elsewhere and kept: coarse before final, found again, damaged, too much, given up.
#include "transport/works.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "base/file.h"
#include "shapes.h"
#include "transport/octahedron.h"
#include "transport/surface.h"
#include "transport/transport_file.h"

namespace mesograin::transport {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

class WorksTest : public testing::Test {
 protected:
  WorksTest()
      : folder_(fs::temp_directory_path() / ("mesograin_works_" + std::to_string(::getpid())) /
                testing::UnitTest::GetInstance()->current_test_info()->name()) {}
  ~WorksTest() override { fs::remove_all(folder_); }

  static Order order(double albedo = 0.5) {
    return {std::make_shared<const scene::Mesh>(cube()), glm::dmat3(1.0), {glm::dvec3(1.0), glm::dvec3(albedo), 1.3}};
  }

  static StoredTransport small() {
    StoredTransport stored;
    stored.size = glm::ivec3(2);
    stored.terms = 4;
    stored.channels = 1;
    const auto surface_nodes = static_cast<std::size_t>(surface_size(stored.size).x);
    stored.distances.assign(surface_nodes * surface_nodes * surface_nodes, 0.5F);
    stored.sources.assign(32, 0.25F);
    stored.lobes.assign(4 * octahedron_texels, 1.0F);
    return stored;
  }

  static Order stretched(double factor) {
    Order stretched = order();
    stretched.stretch[0][0] = factor;
    return stretched;
  }

  static Order open() {
    std::vector<glm::uvec3> faces = box_triangles();
    faces.pop_back();
    Order open = order();
    open.mesh = std::make_shared<const scene::Mesh>(box_positions(), std::vector<glm::vec3>{}, faces);
    return open;
  }

  /// What is kept after all that was asked for: an order that keeps nothing comes after it.
  static std::size_t bytes_of_walks(Works& works) {
    finish(*works.ask(open()));
    return works.bytes_of_walks();
  }

  static void finish(const Computation& computation) {
    while (!computation.wait(20ms)) continue;
  }

  fs::path only_file() const { return fs::directory_iterator(folder_)->path(); }

  fs::path folder_;
};

TEST_F(WorksTest, TellsCoarselyFirstAndFindsAgainWhatItKept) {
  StoredTransport computed;
  {
    Works works{TransportCache(folder_)};
    const auto computation = works.ask(order());
    EXPECT_FALSE(computation->news().final);
    News first;
    while (!first.stored) first = computation->news();
    EXPECT_FALSE(first.final);
    finish(*computation);
    const News last = computation->news();
    ASSERT_TRUE(last.stored);
    EXPECT_EQ(last.number, 2);
    EXPECT_GT(last.stored->nodes(), 4 * first.stored->nodes());
    computed = *last.stored;
  }
  Works works{TransportCache(folder_)};
  const News known = works.ask(order())->news();
  ASSERT_TRUE(known.final && known.stored);
  EXPECT_EQ(known.stored->distances, computed.distances);
  EXPECT_EQ(known.stored->lobes, computed.lobes);
  EXPECT_EQ(known.stored->axes, computed.axes);
  EXPECT_EQ(known.stored->sources, computed.sources) << "a picture depends on what was computed before";
  EXPECT_FALSE(works.ask(order(0.6))->news().final) << "another material's";
}

// A slider that leaves what walks were traced for is answered by them before new ones are traced.
TEST_F(WorksTest, TellsByTheWalksOfAMomentAgo) {
  Works works{TransportCache(folder_)};
  const auto thicker = [](double factor) {
    Order order = WorksTest::order();
    order.medium.sigma_t *= factor;
    return order;
  };
  const auto first = works.ask(thicker(1.0));
  finish(*first);
  const auto within = works.ask(thicker(1.01));
  finish(*within);
  EXPECT_EQ(within->news().number, 2) << "coarsely, and all that there is to know";
  const auto beyond = works.ask(thicker(1.5));
  News recalled;
  while (recalled.number < 2) recalled = beyond->news();
  EXPECT_FALSE(recalled.final);
  EXPECT_EQ(recalled.stored->nodes(), first->news().stored->nodes());
  finish(*beyond);
  EXPECT_EQ(beyond->news().number, 3);
  const auto far = works.ask(thicker(4.0));
  finish(*far);
  EXPECT_EQ(far->news().number, 2) << "they tell nothing of that";
}

// Coarse nodes are too far apart for a thick grain: what is nearer comes before what takes long.
TEST_F(WorksTest, TellsOfAThickGrainInBetween) {
  Works works{TransportCache(folder_)};
  Order thick = order();
  thick.medium.sigma_t *= 8.0;
  const auto computation = works.ask(thick);
  std::vector<std::size_t> nodes;
  for (int number = 1; number <= 2; ++number) {
    News news = computation->news();
    while (news.number < number) news = computation->news();
    ASSERT_TRUE(news.stored && !news.final);
    nodes.push_back(news.stored->nodes());
  }
  EXPECT_GT(nodes[1], 2 * nodes[0]);
}

// What a lamp does is found by the same walks, after all that is asked of a grain itself, and kept as that is.
TEST_F(WorksTest, TellsOfALampAfterAllOthers) {
  const auto beside = [](double place, double height = 2.0) {
    Order order = WorksTest::order();
    const auto at = [place, height](const glm::dvec3& from, const glm::dvec2&) {
      const glm::dvec3 away = glm::dvec3(place, 0.0, height) - from;
      return LampRay{glm::normalize(away), 1.0 / glm::dot(away, away), glm::length(away)};
    };
    order.lamp =
        std::make_shared<const Lamp>(Lamp{at, "at " + std::to_string(place) + " " + std::to_string(height) + "\n"});
    return order;
  };
  std::shared_ptr<const StoredTransport> found;
  {
    Works works{TransportCache(folder_)};
    const auto first = works.ask(order(0.9));  // is being worked on
    const auto lamp = works.ask(beside(0.5));
    const auto second = works.ask(order(0.8));
    finish(*lamp);
    EXPECT_TRUE(first->news().final && second->news().final);
    found = lamp->news().stored;
    ASSERT_TRUE(found);
    EXPECT_EQ(found->terms, 1);
    EXPECT_EQ(found->size, second->news().stored->size);
  }
  Works works{TransportCache(folder_)};
  const News known = works.ask(beside(0.5))->news();
  ASSERT_TRUE(known.final && known.stored);
  EXPECT_EQ(known.stored->sources, found->sources);
  EXPECT_FALSE(works.ask(beside(0.6))->news().final) << "another lamp's";
  const auto inside = works.ask(beside(0.5, 0.7));
  finish(*inside);
  EXPECT_FALSE(inside->news().stored);
  EXPECT_TRUE(inside->news().unsuitable.empty());
}

TEST_F(WorksTest, MakesAnewWhatIsDamaged) {
  const StoredTransport stored = small();
  const TransportCache cache(folder_);
  cache.keep("name", "about", stored);
  ASSERT_TRUE(cache.find("name", "about"));
  EXPECT_FALSE(cache.find("other", "about"));
  std::string bytes = base::read_file(only_file());
  EXPECT_TRUE(from_bytes(bytes, "about"));
  EXPECT_FALSE(from_bytes(bytes, "another"));
  EXPECT_FALSE(from_bytes(bytes.substr(0, bytes.size() / 2), "about"));
  EXPECT_FALSE(from_bytes("", "about"));
  bytes[bytes.size() / 2] ^= 1;
  std::ofstream(only_file(), std::ios::binary) << bytes;
  EXPECT_FALSE(cache.find("name", "about"));
  EXPECT_TRUE(fs::is_empty(folder_)) << "what is damaged is removed";
}

TEST_F(WorksTest, KeepsNoMoreThanItsLimit) {
  const StoredTransport stored = small();
  const std::size_t bytes = to_bytes(stored, "about").size();
  const TransportCache cache(folder_, 3 * bytes + 10);
  for (const char* name : {"a", "b", "c"}) {
    cache.keep(name, "about", stored);
    fs::last_write_time(folder_ / (std::string(name) + ".transport"), fs::file_time_type::clock::now() - 1h);
  }
  ASSERT_TRUE(cache.find("a", "about")) << "used just now";
  cache.keep("d", "about", stored);
  EXPECT_TRUE(cache.find("a", "about") && cache.find("d", "about"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 3);
}

TEST_F(WorksTest, AFolderThatCannotBeHasItComputedAnyway) {
  const TransportCache cache("/proc/nowhere");
  cache.keep("name", "about", {});
  EXPECT_FALSE(cache.find("name", "about"));
}

TEST_F(WorksTest, GivesUpWhatNobodyWaitsFor) {
  Works works{TransportCache(folder_)};
  works.ask(order(0.1));
  const auto computation = works.ask(order(0.2));
  while (!computation->news().stored) continue;
  finish(*computation);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(WorksTest, KeepsTheWalksOfBodiesInUseAndFewOfOthers) {
  Works works{TransportCache(folder_)};
  auto first = works.ask(stretched(1.0));
  finish(*first);
  const std::size_t one = bytes_of_walks(works);
  ASSERT_GT(one, 0U);
  auto second = works.ask(stretched(1.1));
  finish(*second);
  const std::size_t two = bytes_of_walks(works);
  ASSERT_GT(2 * one, WalksShelf::default_limit_of_gone) << "or there is nothing to let go of";
  EXPECT_GT(two, one + one / 2);
  auto third = works.ask(stretched(1.2));
  finish(*third);
  const std::size_t three = bytes_of_walks(works);
  EXPECT_GT(three, two + one / 2) << "all are in use";
  first.reset();
  second = works.ask(stretched(1.1));
  EXPECT_TRUE(second->news().final) << "its file was found; it is in use all the same";
  third.reset();
  const auto fourth = works.ask(stretched(1.3));
  finish(*fourth);
  EXPECT_LE(bytes_of_walks(works), two + WalksShelf::default_limit_of_gone);
}

TEST_F(WorksTest, LetsGoOfWalksOnceTheirBodiesAreInNoScene) {
  Works works{TransportCache(folder_), 20ms};
  std::vector<std::shared_ptr<const Computation>> held;
  for (const double factor : {1.0, 1.1, 1.2}) {
    held.push_back(works.ask(stretched(factor)));
    finish(*held.back());
  }
  const std::size_t all = bytes_of_walks(works);
  ASSERT_GT(all, WalksShelf::default_limit_of_gone) << "or there is nothing to let go of";
  std::this_thread::sleep_for(200ms);
  EXPECT_EQ(works.bytes_of_walks(), all) << "they are in use";
  held.clear();
  for (int tries = 0; tries < 1000 && works.bytes_of_walks() > WalksShelf::default_limit_of_gone; ++tries)
    std::this_thread::sleep_for(20ms);
  EXPECT_LE(works.bytes_of_walks(), WalksShelf::default_limit_of_gone) << "no order came after them";
}

TEST_F(WorksTest, SaysWhatIsNothingForIt) {
  Works works{TransportCache(folder_)};
  const auto hole = works.ask(open());
  Order thick = order();
  thick.medium.sigma_t = glm::dvec3(1e4);
  const auto far = works.ask(thick);
  finish(*hole);
  finish(*far);
  EXPECT_NE(hole->news().unsuitable.find("3 open edges"), std::string::npos) << hole->news().unsuitable;
  EXPECT_NE(far->news().unsuitable.find("mean free paths across"), std::string::npos) << far->news().unsuitable;
  EXPECT_FALSE(hole->news().stored || far->news().stored);
}

}  // namespace
}  // namespace mesograin::transport
