// OBJ and PLY: what modelling programs write comes in right, and what is broken is named with its place.
#include "io/mesh_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "base/file.h"
#include "expect_error.h"
#include "io/triangulate.h"
#include "temporary_folder.h"

namespace mesograin::io {
namespace {

using scene::Mesh;
using test::expect_error;

constexpr std::string_view cube_obj = R"(# a cube, as a modelling program writes it
mtllib cube.mtl
o Cube
v 1 1 -1
v 1 -1 -1
v 1 1 1
v 1 -1 1
v -1 1 -1
v -1 -1 -1
v -1 1 1
v -1 -1 1
usemtl Material
s off
f 1 5 7 3
f 4 3 7 8
f 8 7 5 6
f 6 2 4 8
f 2 1 3 4
f 6 5 1 2
)";

double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const glm::uvec3& triangle : mesh.triangles())
    sum += glm::dot(glm::dvec3(mesh.positions()[triangle.x]),
                    glm::cross(glm::dvec3(mesh.positions()[triangle.y]), glm::dvec3(mesh.positions()[triangle.z])));
  return sum / 6.0;
}

TEST(Obj, ACubeOfQuads) {
  const Mesh cube = parse_obj(cube_obj);
  EXPECT_EQ(cube.positions().size(), 8U);
  EXPECT_EQ(cube.triangles().size(), 12U);
  EXPECT_DOUBLE_EQ(volume(cube), 8.0);
  EXPECT_TRUE(cube.uvs().empty());
  for (std::size_t i = 0; i < 8; ++i) EXPECT_GT(glm::dot(cube.positions()[i], cube.normals()[i]), 0.9F);
}

TEST(Obj, CornersWithUvsAndNormalsBecomeVertices) {
  const Mesh mesh = parse_obj(
      "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nvt 0 0\r\nvt 1 0 0\r\nvt 0 +1e0\r\nvn 0 0 1\r\nvn 0 0.6 0.8\r\n"
      "f 1/1/1 2/2/1 3/3/1\r\nf -3/-3/-1 -2/-2/-1 -1/-1/-1 # comment\r\n");
  EXPECT_EQ(mesh.positions().size(), 6U) << "the second face has other normals";
  EXPECT_EQ(mesh.uvs()[2], glm::vec2(0.0F, 1.0F));
  EXPECT_EQ(mesh.normals()[5], glm::vec3(0.0F, 0.6F, 0.8F));
}

TEST(Obj, ASeamInTheUvsLeavesNoCreaseInTheNormals) {
  const Mesh mesh = parse_obj(
      "v 0 0 0\nv 1 0 1\nv 0 1 0\nv -1 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n"
      "f 1/1 2/2 3/3\nf 1/4 3/2 4/1\n");
  ASSERT_EQ(mesh.positions().size(), 6U);
  EXPECT_EQ(mesh.positions()[0], mesh.positions()[3]);
  EXPECT_NE(mesh.uvs()[0], mesh.uvs()[3]);
  EXPECT_EQ(mesh.normals()[0], mesh.normals()[3]);
}

TEST(Obj, AMissingOrEmptyNormalIsSmoothed) {
  const Mesh mesh = parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nvn 0 0 0\nf 1//1 2//2 3\n");
  EXPECT_EQ(mesh.normals()[0], glm::vec3(1.0F, 0.0F, 0.0F));
  EXPECT_EQ(mesh.normals()[1], glm::vec3(0.0F, 0.0F, 1.0F));
  EXPECT_EQ(mesh.normals()[2], glm::vec3(0.0F, 0.0F, 1.0F));
}

TEST(Obj, WhatIsBrokenIsNamedWithItsLine) {
  const auto expect = [](std::string_view text, const std::string& part) {
    SCOPED_TRACE(std::string(text));
    expect_error([&] { parse_obj(text); }, part);
  };
  expect("", "it holds no face");
  expect("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "it holds no face");
  expect("v 0 0\n", "line 1: 'v' needs 3 finite numbers; got '' as number 3");
  expect("v 0 0 0\nv 0 zero 0\n", "line 2: 'v' needs 3 finite numbers; got 'zero'");
  expect("v 0 0 nan\n", "got 'nan'");
  expect("v 0 0 inf\n", "got 'inf'");
  expect("v 0 0 1e39\n", "got '1e39'");
  expect("v 0 0 1e999\n", "got '1e999'");
  expect("v 0 0 0\nf 1 1\n", "line 2: a face needs 3 to 4096 corners; got 2");
  expect("v 0 0 0\nf 1 2 3\n", "line 2: the corner '2' must name one of the 1 vertices so far");
  expect("v 0 0 0\nf 0 1 1\n", "the corner '0'");
  expect("v 0 0 0\nf 1 1 -2\n", "the corner '-2'");
  expect("v 0 0 0\nf 1/1 1 1\n", "must name one of the 0 UVs so far");
  expect("v 0 0 0\nf 1//1 1 1\n", "must name one of the 0 normals so far");
  expect("v 0 0 0\nf 1 1 99999999999999999999\n", "the corner '99999999999999999999'");
  std::string many = "v 0 0 0\nf";
  for (int i = 0; i < 5000; ++i) many += " 1";
  expect(many, "3 to 4096 corners; got 5000");
}

std::string cube_ply_header(const std::string& format, const std::string& vertex_properties) {
  return "ply\nformat " + format + " 1.0\ncomment a cube\nelement vertex 8\n" + vertex_properties +
         "element face 6\nproperty list uchar int vertex_indices\nproperty uchar red\nelement edge 1\n"
         "property int vertex1\nproperty list uchar short more\nend_header\n";
}

constexpr float cube_positions[8][3] = {{1, 1, -1},  {1, -1, -1},  {1, 1, 1},  {1, -1, 1},
                                        {-1, 1, -1}, {-1, -1, -1}, {-1, 1, 1}, {-1, -1, 1}};
constexpr int cube_faces[6][4] = {{0, 4, 6, 2}, {3, 2, 6, 7}, {7, 6, 4, 5}, {5, 1, 3, 7}, {1, 0, 2, 3}, {5, 4, 0, 1}};

std::string ascii_cube() {
  std::string text = cube_ply_header("ascii",
                                     "property float x\nproperty double y\nproperty float z\nproperty float s\n"
                                     "property float t\n");
  for (const auto& p : cube_positions) text += fmt::format("{} {} {} 0.5 {}\n", p[0], p[1], p[2], p[0]);
  for (const auto& f : cube_faces) text += fmt::format("4 {} {} {} {} 255\n", f[0], f[1], f[2], f[3]);
  return text + "0 2 1 2\n";
}

template <typename Value>
void append(std::string& bytes, Value value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

std::string binary_cube() {
  std::string bytes = cube_ply_header("binary_little_endian",
                                      "property float x\nproperty double y\nproperty float z\nproperty float "
                                      "nx\nproperty float ny\nproperty float nz\n");
  for (const auto& p : cube_positions) {
    append(bytes, p[0]);
    append(bytes, static_cast<double>(p[1]));
    append(bytes, p[2]);
    for (const float component : p) append(bytes, component);
  }
  for (const auto& f : cube_faces) {
    append(bytes, std::uint8_t{4});
    for (const int corner : f) append(bytes, corner);
    append(bytes, std::uint8_t{255});
  }
  append(bytes, 0);
  append(bytes, std::uint8_t{2});
  append(bytes, std::int16_t{1});
  append(bytes, std::int16_t{2});
  return bytes;
}

TEST(Ply, AsciiAndBinaryCubes) {
  const Mesh ascii = parse_ply(ascii_cube());
  EXPECT_DOUBLE_EQ(volume(ascii), 8.0);
  EXPECT_EQ(ascii.uvs()[1], glm::vec2(0.5F, -1.0F)) << "the first face's second corner is vertex 4";
  const Mesh binary = parse_ply(binary_cube());
  EXPECT_DOUBLE_EQ(volume(binary), 8.0);
  EXPECT_EQ(binary.normals()[0], glm::vec3(1.0F, 1.0F, -1.0F));
  EXPECT_TRUE(binary.uvs().empty());
}

TEST(Ply, WhatIsBrokenIsNamedWithItsPlace) {
  const auto expect = [](std::string text, const std::string& from, const std::string& to, const std::string& part) {
    const std::size_t position = text.find(from);
    ASSERT_NE(position, std::string::npos);
    text.replace(position, from.size(), to);
    SCOPED_TRACE(to);
    expect_error([&] { parse_ply(text); }, part);
  };
  const std::string ascii = ascii_cube();
  expect(ascii, "ply", "plx", "line 1: a PLY file begins with 'ply'");
  expect(ascii, "ascii", "binary_big_endian", "line 2: the format must be ascii or binary_little_endian");
  expect(ascii, "format ascii 1.0\n", "", "the header names no format");
  expect(ascii, "end_header", "end", "the header has no 'end_header'");
  expect(ascii, "vertex 8", "vertex many", "line 4: the element 'vertex' needs a count");
  expect(ascii, "vertex 8", "vertex -8", "line 4: the element 'vertex' needs a count");
  expect(ascii, "vertex 8", "vertex 2000000000", "2000000000 elements 'vertex' are announced");
  expect(ascii, "vertex 8", "vertex 0", "it holds no vertex");
  expect(ascii, "property float x", "property real x", "line 5: 'real' is not a type");
  expect(ascii, "property float x", "property float w", "its vertices need the properties x, y and z");
  expect(ascii, "list uchar int vertex_indices", "list uchar int corners", "the list property vertex_indices");
  expect(ascii, "1 1 -1 0.5", "1 one -1 0.5", "line 17: a finite number is needed; got 'one'");
  expect(ascii, "1 1 -1 0.5", "1 nan -1 0.5", "line 17: a finite number is needed; got 'nan'");
  expect(ascii, "4 0 4 6 2", "2 0 4", "a face needs 3 to 4096 corners; got 2");
  expect(ascii, "4 0 4 6 2", "4 0 4 6 8", "a face's corner must name one of the 8 vertices; got 8");
  expect(ascii, "4 0 4 6 2", "4 0 4 6 -1", "must name one of the 8 vertices; got -1");
  expect(ascii, "element face 6", "element face 0", "it holds no face");
  expect(ascii, "0 2 1 2", "0 2 1", "the file ends before");
  const std::string binary = binary_cube();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::string bad = binary;
  std::memcpy(bad.data() + bad.find("end_header\n") + 11, &nan, 4);
  expect_error([&] { parse_ply(bad); }, "the property 'x' must be finite; got nan");
}

TEST(Ply, EveryTruncationIsRefused) {
  for (const std::string& whole : {ascii_cube(), binary_cube()})
    for (std::size_t length = 0; length + 2 < whole.size(); ++length)
      EXPECT_THROW(parse_ply(std::string_view(whole).substr(0, length)), Error) << length;
}

TEST(MeshFiles, DamageNeverDoesMoreThanThrow) {
  std::mt19937 generator(5);
  int refused = 0;
  for (const std::string& whole : {std::string(cube_obj), ascii_cube(), binary_cube()})
    for (int attempt = 0; attempt < 3000; ++attempt) {
      std::string damaged = whole;
      for (int flip = 0; flip < 1 + attempt % 5; ++flip)
        damaged[generator() % damaged.size()] ^= static_cast<char>(1U << (generator() % 8));
      try {
        whole.starts_with("ply") ? parse_ply(damaged) : parse_obj(damaged);
      } catch (const Error&) {
        ++refused;
      }
    }
  EXPECT_GT(refused, 3000);
}

TEST(MeshFiles, TheEndingChoosesTheReaderAndThePathIsNamed) {
  const test::TemporaryFolder folder;
  base::write_file_atomically(folder / "cube.OBJ", cube_obj);
  EXPECT_EQ(read_mesh(folder / "cube.OBJ").triangles().size(), 12U);
  base::write_file_atomically(folder / "cube.ply", binary_cube());
  EXPECT_EQ(read_mesh(folder / "cube.ply").triangles().size(), 12U);
  base::write_file_atomically(folder / "bad.obj", "v 0 0\n");
  expect_error([&] { read_mesh(folder / "bad.obj"); }, "bad.obj: line 1: 'v' needs");
  expect_error([&] { read_mesh(folder / "cube.stl"); }, "must be an .obj or .ply file");
  expect_error([&] { read_mesh(folder / "none.obj"); }, "There is no file");
}

double area(const std::vector<glm::vec3>& corners, const std::vector<glm::uvec3>& triangles) {
  double sum = 0.0;
  for (const glm::uvec3& t : triangles)
    sum += glm::cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x]).z / 2.0;
  return sum;
}

TEST(Triangulate, ConcavePolygonsAreFilledOnce) {
  // An arrow head, a comb and a spiral: a fan would cover ground outside of each.
  const std::vector<std::vector<glm::vec3>> polygons{
      {{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {0.5F, 1, 0}},
      {{0, 0, 0},
       {5, 0, 0},
       {5, 3, 0},
       {4, 3, 0},
       {4, 1, 0},
       {3, 1, 0},
       {3, 3, 0},
       {2, 3, 0},
       {2, 1, 0},
       {1, 1, 0},
       {1, 3, 0},
       {0, 3, 0}},
      {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {1, 4, 0}, {1, 2, 0}, {2, 2, 0}, {2, 3, 0}, {3, 3, 0}, {3, 1, 0}, {0, 1, 0}}};
  const std::vector<double> areas{1.5, 11.0, 10.0};
  for (std::size_t i = 0; i < polygons.size(); ++i)
    for (std::size_t start = 0; start < polygons[i].size(); ++start) {
      std::vector<glm::vec3> corners = polygons[i];
      std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(start), corners.end());
      const std::vector<glm::uvec3> triangles = triangulate(corners);
      EXPECT_EQ(triangles.size(), corners.size() - 2);
      EXPECT_NEAR(area(corners, triangles), areas[i], 1e-6);
      for (const glm::uvec3& t : triangles)
        EXPECT_GT(glm::cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x]).z, 0.0F);
    }
}

TEST(Triangulate, PolygonsWithoutAreaStillEnd) {
  const std::vector<glm::vec3> point(50, glm::vec3(1.0F));
  EXPECT_EQ(triangulate(point).size(), 48U);
  const std::vector<glm::vec3> crossed{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(triangulate(crossed).size(), 2U);
}

}  // namespace
}  // namespace mesograin::io
