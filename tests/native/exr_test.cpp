// EXR files survive the round trip, and no damage to one does more than throw a sentence.
#include "io/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>
#include <string>

#include "base/file.h"
#include "expect_error.h"
#include "temporary_folder.h"

namespace mesograin::io {
namespace {

using base::read_file;
using base::write_file_atomically;
using image::Image;
using test::expect_error;
using test::TemporaryFolder;

Image random_image(int width, int height, int channels, unsigned seed = 1) {
  std::mt19937 generator(seed);
  std::lognormal_distribution<float> radiance(0.0F, 2.0F);
  Image image{.width = width, .height = height, .channels = channels, .pixels = {}};
  for (int sample = 0; sample < width * height * channels; ++sample) image.pixels.push_back(radiance(generator));
  return image;
}

void expect_same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_EQ(std::bit_cast<std::uint32_t>(a[i]), std::bit_cast<std::uint32_t>(b[i])) << "sample " << i;
}

TEST(Exr, FloatsComeBackBitForBitWithNanAndInf) {
  const TemporaryFolder folder;
  Image image = random_image(37, 19, 4);
  image.pixels[0] = std::numeric_limits<float>::quiet_NaN();
  image.pixels[1] = std::numeric_limits<float>::infinity();
  image.pixels[2] = -std::numeric_limits<float>::infinity();
  image.pixels[3] = std::numeric_limits<float>::denorm_min();
  image.pixels[4] = -0.0F;
  const std::map<std::string, std::string> attributes{{"mesograin:parameters", "{\"sigma_a\": [0.1]}"},
                                                      {"seed", "7"},
                                                      {"an attribute with a very long name indeed", ""}};
  write_exr(folder / "a.exr", image.view(), {}, attributes);
  const ExrFile back = read_exr(folder / "a.exr");
  EXPECT_EQ(back.image.width, 37);
  EXPECT_EQ(back.image.height, 19);
  EXPECT_EQ(back.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_EQ(back.attributes, attributes);
  expect_same_bits(back.image.pixels, image.pixels);
  EXPECT_EQ(folder.count(), 1) << "a temporary file was left";
}

TEST(Exr, HalfRoundsToElevenBits) {
  const TemporaryFolder folder;
  const Image image = random_image(20, 33, 3);
  write_exr(folder / "a.exr", image.view(), {}, {}, SampleFormat::half);
  const ExrFile back = read_exr(folder / "a.exr");
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    EXPECT_NEAR(back.image.pixels[i], image.pixels[i], image.pixels[i] * 0x1p-11F) << i;
}

TEST(Exr, AnyChannelsInReadingOrder) {
  const TemporaryFolder folder;
  const Image image = random_image(5, 4, 6);
  write_exr(folder / "a.exr", image.view(), {"shade.B", "Z", "shade.G", "A", "R", "shade.R"});
  const ExrFile back = read_exr(folder / "a.exr");
  EXPECT_EQ(back.channels, (std::vector<std::string>{"R", "A", "Z", "shade.R", "shade.G", "shade.B"}));
  EXPECT_EQ(back.image.view().at(3, 2)[0], image.view().at(3, 2)[4]);
  EXPECT_EQ(back.image.view().at(3, 2)[1], image.view().at(3, 2)[3]);
  EXPECT_EQ(back.image.view().at(3, 2)[5], image.view().at(3, 2)[0]);
}

/// Writes what other programs may: any compression, tiles with or without mipmaps, a data window off the origin.
void write_foreign(const std::filesystem::path& path, const Image& image, Imf::Compression compression, bool tiled,
                   Imf::LevelMode levels = Imf::ONE_LEVEL) {
  const Imath::Box2i window({-3, 5}, {-3 + image.width - 1, 5 + image.height - 1});
  Imf::Header header({{0, 0}, {99, 99}}, window);
  header.compression() = compression;
  Imf::FrameBuffer frame_buffer;
  const char* names[] = {"R", "G", "B", "A"};
  for (int channel = 0; channel < image.channels; ++channel) {
    header.channels().insert(names[channel], Imf::Channel(Imf::FLOAT));
    const std::size_t stride = sizeof(float) * image.channels;
    frame_buffer.insert(names[channel], Imf::Slice::Make(Imf::FLOAT, image.pixels.data() + channel, window, stride,
                                                         stride * image.width));
  }
  if (tiled) {
    header.setTileDescription(Imf::TileDescription(16, 8, levels));
    Imf::TiledOutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame_buffer);
    file.writeTiles(0, file.numXTiles(0) - 1, 0, file.numYTiles(0) - 1, 0);
    for (int level = 1; levels == Imf::MIPMAP_LEVELS && level < file.numLevels(); ++level)
      file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
  } else {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame_buffer);
    file.writePixels(image.height);
  }
}

TEST(Exr, ReadsEveryLosslessLayout) {
  const TemporaryFolder folder;
  const Image image = random_image(45, 39, 3);
  for (const bool tiled : {false, true})
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                               Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
      SCOPED_TRACE(testing::Message() << "compression " << compression << (tiled ? ", tiled" : ""));
      write_foreign(folder / "a.exr", image, compression, tiled);
      expect_same_bits(read_exr(folder / "a.exr").image.pixels, image.pixels);
    }
  write_foreign(folder / "a.exr", image, Imf::ZIP_COMPRESSION, true, Imf::MIPMAP_LEVELS);
  expect_same_bits(read_exr(folder / "a.exr").image.pixels, image.pixels);
}

TEST(Exr, ReadsEveryLossyLayoutNearly) {
  const TemporaryFolder folder;
  Image image{.width = 40, .height = 300, .channels = 3, .pixels = {}};
  for (int sample = 0; sample < 40 * 300 * 3; ++sample)
    image.pixels.push_back(1.0F + 0.5F * std::sin(static_cast<float>(sample) * 1e-3F));
  for (const Imf::Compression compression : {Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION,
                                             Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
    SCOPED_TRACE(testing::Message() << "compression " << compression);
    write_foreign(folder / "a.exr", image, compression, false);
    const ExrFile back = read_exr(folder / "a.exr");
    ASSERT_EQ(back.image.pixels.size(), image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      ASSERT_NEAR(back.image.pixels[i], image.pixels[i], 0.03F) << i;
  }
}

TEST(Exr, RefusesWhatItWouldMisread) {
  const TemporaryFolder folder;
  std::vector<float> samples(64, 1.0F);
  {
    Imf::Header header(8, 8);
    header.channels().insert("BY", Imf::Channel(Imf::FLOAT, 2, 2));
    Imf::FrameBuffer frame_buffer;
    frame_buffer.insert("BY", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), 4, 16, 2, 2));
    Imf::OutputFile file((folder / "subsampled.exr").c_str(), header);
    file.setFrameBuffer(frame_buffer);
    file.writePixels(8);
  }
  expect_error([&] { read_exr(folder / "subsampled.exr"); }, "'BY' is subsampled");
  {
    Imf::Header header(8, 8);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    header.setType(Imf::SCANLINEIMAGE);
    std::vector<Imf::Header> headers{header, header};
    headers[0].setName("one");
    headers[1].setName("two");
    Imf::MultiPartOutputFile file((folder / "parts.exr").c_str(), headers.data(), 2);
    Imf::FrameBuffer frame_buffer;
    frame_buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), 4, 32));
    for (int part = 0; part < 2; ++part) {
      Imf::OutputPart output(file, part);
      output.setFrameBuffer(frame_buffer);
      output.writePixels(8);
    }
  }
  expect_error([&] { read_exr(folder / "parts.exr"); }, "several parts");
}

TEST(Exr, MissingAndForeignFilesAreNamed) {
  const TemporaryFolder folder;
  expect_error([&] { read_exr(folder / "none.exr"); }, "There is no file");
  expect_error([&] { read_exr(folder / "none/none.exr"); }, "There is no file");
  expect_error([&] { read_exr(folder / ""); }, "not one");
  write_file_atomically(folder / "text.exr", "not a picture at all");
  expect_error([&] { read_exr(folder / "text.exr"); }, "not an OpenEXR file");
  write_file_atomically(folder / "empty.exr", "");
  expect_error([&] { read_exr(folder / "empty.exr"); }, "not an OpenEXR file");
  ASSERT_EQ(mkfifo((folder / "pipe.exr").c_str(), 0600), 0);
  expect_error([&] { read_exr(folder / "pipe.exr"); }, "not one");
}

std::string small_file(const TemporaryFolder& folder, Imf::Compression compression, bool tiled) {
  write_foreign(folder / "small.exr", random_image(23, 18, 3), compression, tiled);
  return read_file(folder / "small.exr");
}

/// Reads damaged bytes: a picture or an Error may come, nothing else.
bool is_readable(std::string bytes) {
  try {
    parse_exr(std::move(bytes));
    return true;
  } catch (const Error& error) {
    const std::string sentence = error.what();
    EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
    EXPECT_EQ(sentence.back(), '.') << sentence;
    return false;
  }
}

TEST(Exr, EveryTruncationIsRefused) {
  const TemporaryFolder folder;
  for (const bool tiled : {false, true}) {
    const std::string bytes = small_file(folder, Imf::ZIP_COMPRESSION, tiled);
    ASSERT_TRUE(is_readable(bytes));
    for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 200)
      EXPECT_FALSE(is_readable(bytes.substr(0, length))) << length << " of " << bytes.size() << " bytes";
    EXPECT_FALSE(is_readable(bytes.substr(0, bytes.size() - 1)));
  }
}

TEST(Exr, FlippedBitsNeverDoMoreThanThrow) {
  const TemporaryFolder folder;
  std::mt19937 generator(20);
  int refused = 0;
  for (const bool tiled : {false, true})
    for (const Imf::Compression compression :
         {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION,
          Imf::B44_COMPRESSION, Imf::DWAA_COMPRESSION}) {
      const std::string bytes = small_file(folder, compression, tiled);
      for (int attempt = 0; attempt < 300; ++attempt) {
        std::string damaged = bytes;
        // Most of the danger is in the header and in the table of blocks.
        const std::size_t reach = attempt % 2 ? bytes.size() : std::min<std::size_t>(bytes.size(), 500);
        for (int flip = 0; flip < 1 + attempt % 4; ++flip)
          damaged[generator() % reach] ^= static_cast<char>(1U << (generator() % 8));
        if (!is_readable(damaged)) ++refused;
      }
    }
  EXPECT_GT(refused, 500);
}

TEST(Exr, HugeSizesAreRefusedBeforeTheyAreAllocated) {
  const TemporaryFolder folder;
  std::string bytes = small_file(folder, Imf::NO_COMPRESSION, false);
  const std::size_t window = bytes.find(std::string("dataWindow\0box2i\0", 17)) + 17 + 4;
  const auto announce = [&](std::int32_t width, std::int32_t height) {
    const std::int32_t box[] = {0, 0, width - 1, height - 1};
    std::memcpy(bytes.data() + window, box, sizeof(box));
    write_file_atomically(folder / "huge.exr", bytes);
  };
  announce(2000000000, 2000000000);
  expect_error([&] { read_exr(folder / "huge.exr"); }, "2000000000 x 2000000000");
  announce(60000, 60000);
  expect_error([&] { read_exr(folder / "huge.exr"); }, "60000 x 60000");
  announce(65535, 1000);  // few enough, but not there
  expect_error([&] { read_exr(folder / "huge.exr"); }, "Can't read");
}

TEST(Exr, DoesNotReadBeyondWhatALineHas) {
  const TemporaryFolder folder;
  for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION}) {
    std::string bytes = small_file(folder, compression, false);
    const std::size_t window = bytes.find(std::string("dataWindow\0box2i\0", 17)) + 17 + 4;
    const std::int32_t box[] = {0, 0, 65534, 17};
    std::memcpy(bytes.data() + window, box, sizeof(box));
    EXPECT_FALSE(is_readable(bytes)) << "compression " << compression;
  }
}

TEST(Exr, RefusesNamesAndShapesThatDoNotFit) {
  const TemporaryFolder folder;
  const Image image = random_image(4, 4, 3);
  const std::filesystem::path path = folder / "a.exr";
  expect_error([&] { write_exr(path, image.view(), {"R", "G"}); }, "as many names; got 2");
  expect_error([&] { write_exr(path, image.view(), {"R", "G", "G"}); }, "different names");
  expect_error([&] { write_exr(path, image.view(), {"R", "G", ""}); }, "1 to 255 bytes");
  expect_error([&] { write_exr(path, image.view(), {}, {{"channels", "x"}}); }, "'channels' is reserved");
  expect_error([&] { write_exr(path, image.view(), {}, {{std::string(256, 'n'), "x"}}); }, "1 to 255 bytes");
  expect_error([&] { write_exr(path, random_image(4, 4, 2).view()); }, "needs a name for each");
  expect_error([&] { write_exr(path, Image{}.view()); }, "at least one pixel");
  EXPECT_TRUE(folder.is_empty());
}

TEST(Exr, PlacesThatCannotBeWrittenAreNamed) {
  const TemporaryFolder folder;
  const Image image = random_image(4, 4, 3);
  expect_error([&] { write_exr(folder / "none/a.exr", image.view()); }, "its folder does not exist");
  write_file_atomically(folder / "file", "x");
  expect_error([&] { write_exr(folder / "file/a.exr", image.view()); }, "is a file");
  std::filesystem::create_directory(folder / "a.exr");
  expect_error([&] { write_exr(folder / "a.exr", image.view()); }, "a folder or device of that name");
  expect_error([&] { write_exr("/dev/null", image.view()); }, "a folder or device of that name");
  expect_error([&] { write_exr("/proc/a.exr", image.view()); }, "Can't write /proc/a.exr");
  expect_error([&] { write_exr("", image.view()); }, "a file name is needed");
  EXPECT_EQ(folder.count(), 2);
}

TEST(Exr, AFullDiskLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  const Image old = random_image(4, 4, 3);
  write_exr(folder / "a.exr", old.view());
  struct rlimit before {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit tight { 2000, before.rlim_max };
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  expect_error([&] { write_exr(folder / "a.exr", random_image(64, 64, 3).view()); }, "the disk is full");
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(folder.count(), 1);
  expect_same_bits(read_exr(folder / "a.exr").image.pixels, old.pixels);
}

TEST(Exr, WhatAKilledProcessLeftIsInNobodysWay) {
  const TemporaryFolder folder;
  const Image image = random_image(4, 4, 3);
  // More names than this process can have used: the next one is among them.
  for (int count = 0; count < 20000; ++count)
    std::ofstream(folder / ("." + std::to_string(::getpid()) + "." + std::to_string(count) + ".tmp")) << "half";
  write_exr(folder / "a.exr", image.view());
  EXPECT_EQ(folder.count(), 20001);
  expect_same_bits(read_exr(folder / "a.exr").image.pixels, image.pixels);
}

TEST(Exr, WritesThroughALink) {
  const TemporaryFolder folder;
  const Image image = random_image(4, 4, 3);
  write_file_atomically(folder / "target.exr", "old");
  std::filesystem::create_symlink("target.exr", folder / "link.exr");
  write_exr(folder / "link.exr", image.view());
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.exr"));
  expect_same_bits(read_exr(folder / "target.exr").image.pixels, image.pixels);
}

}  // namespace
}  // namespace mesograin::io
