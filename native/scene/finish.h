// What a surface has beside its model's parameters: pictures that it wears, a coat that reflects, light of its own.
#pragma once

#include <array>
#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <string_view>
#include <variant>
#include <vector>

namespace mesograin::scene {

/// Texels as a file holds them, row 0 at the top: bytes, or linear numbers.
class Picture {
 public:
  using Bytes = std::vector<glm::u8vec4>;
  using Numbers = std::vector<glm::vec4>;

  /// `srgb`: red, green and blue are to be made linear, after they were interpolated. Throws Error unless there is a
  /// texel for each place, and all of them are finite.
  Picture(int width, int height, std::variant<Bytes, Numbers> texels, bool srgb);

  int width() const { return width_; }
  int height() const { return height_; }
  const std::variant<Bytes, Numbers>& texels() const { return texels_; }
  bool srgb() const { return srgb_; }

 private:
  int width_;
  int height_;
  std::variant<Bytes, Numbers> texels_;
  bool srgb_;
};

/// What is seen beyond a picture's edges: the picture again, its edge, nothing, or the picture mirrored.
enum class Wrap { repeat, extend, clip, mirror };
inline constexpr std::array<std::string_view, 4> wrap_names{"repeat", "extend", "clip", "mirror"};

/// How a picture lies on a mesh.
struct TextureMap {
  std::shared_ptr<const Picture> picture;  ///< null: there is none
  bool by_position = false;  ///< by the place in the mesh's own space, (x, y, z, 1); else by UV, (u, v, 0, 1)
  std::array<glm::dvec4, 2> to_picture{
      {{1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}}};  ///< across; up, from its lower left
  Wrap wrap = Wrap::repeat;
  bool smooth = true;  ///< between texels; else the nearest

  bool operator==(const TextureMap&) const = default;
};

/// For opaque models, whose reflectance and roughness it overrides where there is a picture. The diffuse share of the
/// surface is what is not metallic.
struct Finish {
  TextureMap reflectance;
  TextureMap roughness;  ///< the square root of the GGX alpha, the mean of R, G and B
  TextureMap metallic;   ///< the mean of R, G and B
  TextureMap normal;     ///< in tangent space, of UV
  TextureMap emission;   ///< multiplies the radiance that it sends out
  double metallicity = 0.0;
  double normal_strength = 1.0;
  double coat = 0.0;                ///< reflectance of the dielectric over the diffuse share, seen straight on
  double coat_roughness = 0.5;      ///< as roughness
  bool retro_reflective = false;    ///< diffuse as Burley (2012) has it, not Lambertian
  double diffuse_roughness = 0.0;   ///< else as Oren and Nayar (1994) have it, in Fujii's form; 0: Lambertian
  bool coat_shades_base = false;    ///< what the coat reflects is lost to what lies under it
  bool metal_whitens = false;       ///< the conductor's reflectance rises to 1 at grazing (Schlick 1994)
  bool facets_keep_energy = false;  ///< what one bounce off facets loses is sent on in their lobe (Turquin 2019)
  bool facets_shade_bumps = false;  ///< what a bent normal shades of itself is masked as facets are (Estevez et al.
                                    ///< 2019); else by Cycles' former cubic
  bool bent_normals_stay = false;   ///< for the diffuse share; else they are bent back until a mirror would reflect
  glm::dvec3 radiance{0.0};         ///< that it sends out, linear RGB
  bool faces_are_lights = false;    ///< area lights of the scene stand for what it sends out

  bool operator==(const Finish&) const = default;
};

/// Throws Error naming the first number that is out of range.
void validate(const Finish& finish);

}  // namespace mesograin::scene
