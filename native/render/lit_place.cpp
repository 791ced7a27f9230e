// Where a ray begins, so that it meets neither the triangle it comes from nor misses the one beside it.
#include "render/lit_place.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace mesograin::render {
namespace {

// Of a grain's radius: how far from its own surface a ray begins that may meet it again.
constexpr float clear_of_itself = 1e-4F;

// What of an instance its shadows depend on.
struct Shaded {
  glm::vec4 ball;
  std::uint32_t number;  // by which shadows know it
  bool itself;           // it may stand in its own light
};

Shaded shaded_of(const Content& content, std::size_t number) {
  const Instances* instances = content.instances();
  const std::size_t count = instances != nullptr ? instances->count() : 0;
  if (number < count)
    return {instances->ball(number), static_cast<std::uint32_t>(number), instances->shades_itself(number)};
  const std::size_t index = number - count;
  const Draw& draw = content.draws()[index];
  return {glm::vec4(glm::vec3(draw.centre - content.anchor()), static_cast<float>(draw.radius)),
          static_cast<std::uint32_t>(content.object_number(index)), content.shades_itself(draw)};
}

}  // namespace

LitPlace lit_place(const Content& content, const glm::vec4& position, const glm::vec4& facing,
                   const glm::vec4& viewer) {
  const Shaded shaded = shaded_of(content, static_cast<std::size_t>(std::abs(facing.w)) - 1);
  glm::vec3 normal(facing);
  glm::vec3 place = glm::vec3(shaded.ball) + glm::vec3(position);
  const glm::vec3 to_viewer = glm::normalize(glm::vec3(viewer) - viewer.w * place);
  float cosine = glm::dot(normal, to_viewer);
  constexpr float grazing = -0.1F;
  if (facing.w < 0.0F && cosine < grazing) {
    normal = -normal;
    cosine = -cosine;
  }
  constexpr float least_cosine = 1e-4F;
  if (cosine < least_cosine) normal = glm::normalize(normal + (least_cosine - cosine) * to_viewer);
  if (!shaded.itself) return {place, normal, 0.0F, shaded.number};
  // From the tangent planes of the triangle's corners: a facet that turns from the light where its curve does not yet
  // would stand in its own light (Hanika, "Hacking the Shadow Terminator", 2021). The curved surface rises half as far.
  const float clearance = clear_of_itself * shaded.ball.w;
  place += 2.0F * std::max(position.w, 0.0F) * glm::vec3(facing) + clearance * normal;
  return {place, normal, clearance, shaded.number};
}

bool set_off(casting::Packet& packet, unsigned ray, const LitPlace& from, const glm::vec3& along, float farthest) {
  if (glm::dot(along, from.normal) <= 0.0F) return false;
  packet.set(ray, from.place, along, farthest);
  packet.from[ray] = from.object;
  packet.own[ray] = from.clearance / glm::length(along);
  return true;
}

}  // namespace mesograin::render
