// OpenEXR does the coding; this file guards its door. Headers are checked before the library allocates by them, and
// every exception becomes one sentence.
#include "io/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <exception>
#include <limits>
#include <new>
#include <set>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "base/file.h"

namespace mesograin::io {

using image::ImageView;

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t largest_side = 65535;
constexpr std::int64_t most_samples = std::int64_t{1} << 30;
constexpr std::size_t longest_name = 255;

/// What is wrong with a file, before its path is known.
class Corrupt : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(std::string& bytes) : Imf::IStream("an OpenEXR file"), bytes_(bytes) {}

  // Not as memory that is mapped: of that OpenEXR reads as much as a block should have, however much it has.
  bool read(char target[], int count) override {
    const char* start = bytes_.data() + position_;
    advance(count);
    std::memcpy(target, start, static_cast<std::size_t>(count));
    return position_ < bytes_.size();
  }
  uint64_t tellg() override { return position_; }
  void seekg(uint64_t position) override {
    if (position > bytes_.size()) throw Corrupt("it ends too early");
    position_ = position;
  }

 private:
  void advance(int count) {
    if (count < 0 || static_cast<std::uint64_t>(count) > bytes_.size() - position_) throw Corrupt("it ends too early");
    position_ += static_cast<std::uint64_t>(count);
  }

  std::string& bytes_;
  std::uint64_t position_ = 0;
};

class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : Imf::OStream("an OpenEXR file") {}

  void write(const char source[], int count) override {
    const std::size_t end = position_ + static_cast<std::size_t>(count);
    if (end > bytes_.size()) bytes_.resize(end);
    std::memcpy(bytes_.data() + position_, source, static_cast<std::size_t>(count));
    position_ = end;
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

template <typename Integer>
Integer little_endian(const std::string& bytes, std::size_t position) {
  if (position > bytes.size() || bytes.size() - position < sizeof(Integer)) throw Corrupt("it ends too early");
  std::uint64_t value = 0;
  for (std::size_t byte = sizeof(Integer); byte-- > 0;)
    value = value << 8 | static_cast<unsigned char>(bytes[position + byte]);
  return static_cast<Integer>(value);
}

/// The position after the zero that ends the name at `position`.
std::size_t skip_name(const std::string& bytes, std::size_t position) {
  const std::size_t end = bytes.find('\0', position);
  if (end == std::string::npos || end - position > longest_name) throw Corrupt("its header is damaged");
  return end + 1;
}

/// Walks the header's attributes and returns where it ends: OpenEXR allocates what an attribute says is its size.
std::size_t end_of_header(const std::string& bytes) {
  if (bytes.size() < 8 || little_endian<std::int32_t>(bytes, 0) != Imf::MAGIC)
    throw Corrupt("it is not an OpenEXR file");
  const auto version = little_endian<std::int32_t>(bytes, 4);
  if (Imf::isMultiPart(version)) throw Corrupt("it has several parts and one is needed; extract the part you want");
  if (Imf::isNonImage(version)) throw Corrupt("it holds deep data and a flat image is needed; flatten it first");
  std::size_t position = 8;
  while (true) {
    const std::size_t after_name = skip_name(bytes, position);
    if (after_name == position + 1) return after_name;
    const std::size_t after_type = skip_name(bytes, after_name);
    const auto size = little_endian<std::int32_t>(bytes, after_type);
    position = after_type + 4;
    if (size < 0 || static_cast<std::size_t>(size) > bytes.size() - position) throw Corrupt("its header is damaged");
    position += static_cast<std::size_t>(size);
  }
}

int lines_in_chunk(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
    case Imf::RLE_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
      return 1;
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
      return 32;
    case Imf::DWAB_COMPRESSION:
      return 256;
    default:
      throw Corrupt("its compression is unknown");
  }
}

std::int64_t divide_up(std::int64_t value, std::int64_t divisor) { return (value + divisor - 1) / divisor; }

std::int64_t chunks_of_finest_level(const Imf::Header& header, std::int64_t width, std::int64_t height) {
  if (!header.hasTileDescription()) return divide_up(height, lines_in_chunk(header.compression()));
  const Imf::TileDescription& tiles = header.tileDescription();
  if (tiles.xSize < 1 || tiles.ySize < 1 || tiles.xSize > largest_side || tiles.ySize > largest_side)
    throw Corrupt("its tiles have an impossible size");
  return divide_up(width, tiles.xSize) * divide_up(height, tiles.ySize);
}

/// Refuses what would cost memory or time out of proportion, and files whose pixels are not all there.
void check_header(const Imf::Header& header, const std::string& bytes, std::size_t chunk_table) {
  const Imath::Box2i& window = header.dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  std::int64_t channels = 0;
  std::int64_t bytes_of_pixel = 0;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1)
      throw Corrupt(
          fmt::format("its channel '{}' is subsampled and full resolution is needed; save it as RGB", channel.name()));
    ++channels;
    bytes_of_pixel += channel.channel().type == Imf::HALF ? 2 : 4;
  }
  if (channels == 0) throw Corrupt("it has no channels");
  if (width < 1 || height < 1) throw Corrupt(fmt::format("its size is {} x {} pixels", width, height));
  if (width > largest_side || height > largest_side || width * height > most_samples / channels)
    throw Corrupt(
        fmt::format("it announces {} x {} pixels of {} channels, more than the {} a side and {} samples allowed", width,
                    height, channels, largest_side, most_samples));

  const std::int64_t chunks = chunks_of_finest_level(header, width, height);
  if (chunks > static_cast<std::int64_t>((bytes.size() - chunk_table) / 8)) throw Corrupt("it ends too early");
  const bool as_they_are = header.compression() == Imf::NO_COMPRESSION && !header.hasTileDescription();
  std::int64_t missing = 0;
  for (std::int64_t chunk = 0; chunk < chunks; ++chunk) {
    const auto offset = little_endian<std::uint64_t>(bytes, chunk_table + static_cast<std::size_t>(chunk) * 8);
    if (offset < chunk_table || offset > bytes.size() - 8)
      ++missing;
    else if (as_they_are && little_endian<std::int32_t>(bytes, offset + 4) != width * bytes_of_pixel)
      throw Corrupt(fmt::format("its blocks of pixels are not {} pixels wide", width));
  }
  if (missing > 0) throw Corrupt(fmt::format("{} of its {} blocks of pixels are missing", missing, chunks));
}

/// Layer by layer; R, G, B, A before other names.
std::tuple<std::string, std::size_t, std::string> channel_order(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  const std::string layer = dot == std::string::npos ? "" : name.substr(0, dot);
  const std::string base = dot == std::string::npos ? name : name.substr(dot + 1);
  constexpr std::string_view colours = "RGBA";
  const std::size_t colour = base.size() == 1 ? colours.find(base[0]) : std::string_view::npos;
  return {layer, colour, base};
}

ExrFile decode(std::string& bytes) {
  const std::size_t chunk_table = end_of_header(bytes);
  MemoryInput stream(bytes);
  stream.seekg(8);
  Imf::Header header;
  int version = little_endian<std::int32_t>(bytes, 4);
  header.readFrom(stream, version);
  if (!Imf::isTiled(version)) header.erase("tiles");  // as OpenEXR does: the flag decides
  check_header(header, bytes, chunk_table);
  header.sanityCheck(Imf::isTiled(version));

  ExrFile file;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
    file.channels.emplace_back(channel.name());
  std::sort(file.channels.begin(), file.channels.end(),
            [](const std::string& a, const std::string& b) { return channel_order(a) < channel_order(b); });
  for (auto attribute = header.begin(); attribute != header.end(); ++attribute)
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute()))
      file.attributes[attribute.name()] = text->value();

  const Imath::Box2i window = header.dataWindow();
  file.image.width = window.max.x - window.min.x + 1;
  file.image.height = window.max.y - window.min.y + 1;
  file.image.channels = static_cast<int>(file.channels.size());
  const std::size_t samples_in_row = static_cast<std::size_t>(file.image.width) * file.channels.size();
  file.image.pixels.resize(samples_in_row * static_cast<std::size_t>(file.image.height));

  Imf::FrameBuffer frame_buffer;
  for (std::size_t channel = 0; channel < file.channels.size(); ++channel)
    frame_buffer.insert(file.channels[channel],
                        Imf::Slice::Make(Imf::FLOAT, file.image.pixels.data() + channel, window,
                                         sizeof(float) * file.channels.size(), sizeof(float) * samples_in_row));
  stream.seekg(0);
  Imf::InputFile input(stream);
  input.setFrameBuffer(frame_buffer);
  input.readPixels(window.min.y, window.max.y);
  return file;
}

std::string one_line(std::string text) {
  for (char& letter : text)
    if (static_cast<unsigned char>(letter) < ' ') letter = ' ';
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text;
}

std::vector<std::string> default_channels(int count) {
  switch (count) {
    case 1:
      return {"Y"};
    case 3:
      return {"R", "G", "B"};
    case 4:
      return {"R", "G", "B", "A"};
    default:
      throw Error("An EXR of {} channels needs a name for each; only 1, 3 and 4 channels have default names.", count);
  }
}

void require_name(std::string_view what, const std::string& name) {
  if (name.empty() || name.size() > longest_name || name.find('\0') != std::string::npos)
    throw Error("The name of an EXR's {} must have 1 to {} bytes, none of them zero; got '{}'.", what, longest_name,
                one_line(name));
}

void require_shape(const ImageView& image) {
  if (image.width < 1 || image.height < 1 || image.channels < 1)
    throw Error("An EXR needs at least one pixel and one channel; got {} x {} pixels of {} channels.", image.width,
                image.height, image.channels);
  if (image.width > largest_side || image.height > largest_side)
    throw Error("An EXR may have at most {} pixels a side; got {} x {}.", largest_side, image.width, image.height);
}

Imf::Header make_header(const ImageView& image, const std::vector<std::string>& channels,
                        const std::map<std::string, std::string>& attributes, Imf::PixelType type) {
  if (channels.size() != static_cast<std::size_t>(image.channels))
    throw Error("An EXR of {} channels needs as many names; got {}.", image.channels, channels.size());
  if (const std::set<std::string> distinct(channels.begin(), channels.end()); distinct.size() != channels.size())
    throw Error("The channels of an EXR need different names; got {} for {} channels.", distinct.size(),
                channels.size());

  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const std::string& channel : channels) {
    require_name("channel", channel);
    header.channels().insert(channel, Imf::Channel(type));
  }
  for (const auto& [name, value] : attributes) {
    require_name("attribute", name);
    if (header.find(name) != header.end())
      throw Error("The EXR attribute '{}' is reserved for the file itself; choose another name.", name);
    header.insert(name, Imf::StringAttribute(value));
  }
  return header;
}

/// OpenEXR wants samples in the file's own type.
std::vector<half> to_half(const ImageView& image) {
  const std::size_t samples =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * image.channels;
  return {image.pixels, image.pixels + samples};
}

}  // namespace

ExrFile parse_exr(std::string bytes) {
  try {
    return decode(bytes);
  } catch (const std::bad_alloc&) {
    throw Error("there is not enough memory for it.");
  } catch (const std::exception& problem) {
    throw Error("{}.", one_line(problem.what()));
  }
}

ExrFile read_exr(const fs::path& path) {
  std::string bytes = base::read_file(path);
  try {
    return parse_exr(std::move(bytes));
  } catch (const Error& error) {
    throw Error("Can't read {}: {}", path.string(), error.what());
  }
}

void write_exr(const fs::path& path, const ImageView& image, std::vector<std::string> channels,
               const std::map<std::string, std::string>& attributes, SampleFormat format) {
  try {
    require_shape(image);
    if (channels.empty()) channels = default_channels(image.channels);
    const Imf::PixelType type = format == SampleFormat::half ? Imf::HALF : Imf::FLOAT;
    const Imf::Header header = make_header(image, channels, attributes, type);
    const std::vector<half> halves = format == SampleFormat::half ? to_half(image) : std::vector<half>{};

    const std::size_t sample = format == SampleFormat::half ? sizeof(half) : sizeof(float);
    // OpenEXR's frame buffers are not const, but writing only reads them.
    char* const first = format == SampleFormat::half ? reinterpret_cast<char*>(const_cast<half*>(halves.data()))
                                                     : reinterpret_cast<char*>(const_cast<float*>(image.pixels));
    Imf::FrameBuffer frame_buffer;
    for (std::size_t channel = 0; channel < channels.size(); ++channel)
      frame_buffer.insert(channels[channel], Imf::Slice(type, first + channel * sample, sample * channels.size(),
                                                        sample * channels.size() * image.width));
    MemoryOutput stream;
    {
      Imf::OutputFile output(stream, header);
      output.setFrameBuffer(frame_buffer);
      output.writePixels(image.height);
    }  // its destructor completes the table of blocks
    base::write_file_atomically(path, stream.bytes());
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error("Can't write {}: there is not enough memory for it.", path.string());
  } catch (const std::exception& problem) {
    throw Error("Can't write {}: {}.", path.string(), one_line(problem.what()));
  }
}

}  // namespace mesograin::io
