// What is all around the scene: a colour, or an image of the surroundings.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

namespace mesograin::scene {

/// An equirectangular picture of all directions, row 0 at the top, linear RGB: z is up, the middle column looks along
/// +x, and further right is further clockwise seen from above, as Blender has it.
class Surroundings {
 public:
  /// Throws Error unless there is a texel for each place, and all of them are finite and not negative.
  Surroundings(int width, int height, std::vector<glm::vec3> texels);

  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<glm::vec3>& texels() const { return texels_; }

 private:
  int width_;
  int height_;
  std::vector<glm::vec3> texels_;
};

/// What a camera sees where the world is; as a world has it, but no light.
struct Backdrop {
  glm::dvec3 radiance{0.0};
  std::shared_ptr<const Surroundings> image;
  glm::dmat3 world_to_image{1.0};

  bool operator==(const Backdrop&) const = default;
};

struct World {
  glm::dvec3 radiance{0.0};  ///< linear RGB, from every direction; multiplies the image if there is one
  std::shared_ptr<const Surroundings> image;
  glm::dmat3 world_to_image{1.0};      ///< rotates or mirrors a direction before it is looked up
  bool seen = false;                   ///< behind the grains; else the picture is transparent there
  std::optional<Backdrop> backdrop{};  ///< seen instead, if it is seen
  bool film_transparent = false;       ///< the picture is where grains that do not refract show the world, too

  /// What a camera sees of it, straight on and through grains that do not refract.
  Backdrop seen_by_camera() const;

  /// Whether any light comes from it.
  bool shines() const { return radiance != glm::dvec3(0.0); }

  bool operator==(const World&) const = default;
};

/// Throws Error if a radiance is negative, a rotation is none, or a number is not finite.
void validate(const World& world);

}  // namespace mesograin::scene
