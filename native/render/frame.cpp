// Draws samples and accumulates them.
#include "render/frame.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "render/sequence.h"

namespace mesograin::render {
namespace {

struct DeviceLight {
  glm::vec4 to_light;
  glm::vec4 irradiance;
};

// A direction uniformly distributed over the cone of full angle `angle` around `axis`.
glm::dvec3 sample_cone(const glm::dvec3& axis, double angle, const glm::dvec2& point) {
  constexpr double two_pi = 6.28318530717958647692;
  const double half_sine = std::sin(angle / 4.0);
  const double one_minus_cosine = point.x * 2.0 * half_sine * half_sine;
  const double sine = std::sqrt(one_minus_cosine * (2.0 - one_minus_cosine));
  const glm::dvec3 helper = std::abs(axis.x) < 0.5 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 tangent = glm::normalize(glm::cross(axis, helper));
  const glm::dvec3 bitangent = glm::cross(axis, tangent);
  const double azimuth = two_pi * point.y;
  return (1.0 - one_minus_cosine) * axis + sine * (std::cos(azimuth) * tangent + std::sin(azimuth) * bitangent);
}

}  // namespace

Frame::Targets::Targets(int width, int height)
    : sample(GL_RGBA32F, width, height),
      depth(GL_DEPTH_COMPONENT32F, width, height),
      sum(GL_RGBA32F, width, height),
      shade({&sample}, &depth),
      accumulate({&sum}) {}

Frame::Frame(DeviceCache& cache, int width, int height, std::uint32_t seed)
    : cache_(cache),
      width_(width),
      height_(height),
      seed_(seed),
      targets_(std::make_unique<Targets>(width, height)),
      accumulate_program_("accumulate", gl::ShaderSource({"passes/full_screen.vert"}, {}),
                          gl::ShaderSource({"passes/accumulate.frag"}, {})),
      resolve_program_("resolve", gl::ShaderSource({"passes/full_screen.vert"}, {}),
                       gl::ShaderSource({"passes/resolve.frag"}, {})) {}

void Frame::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  targets_ = std::make_unique<Targets>(width, height);
  width_ = width;
  height_ = height;
  samples_ = 0;
}

void Frame::set_scene(scene::Scene scene) {
  std::vector<Draw> draws;
  for (const scene::Instance& instance : scene.instances)
    draws.push_back({cache_.mesh(instance.mesh), cache_.material(instance.material), instance.object_to_world});
  // Neighbours that share a material need it bound once.
  std::stable_sort(draws.begin(), draws.end(),
                   [](const Draw& a, const Draw& b) { return a.material.get() < b.material.get(); });
  draws_ = std::move(draws);
  lights_ = std::move(scene.lights);
  samples_ = 0;
  cache_.prune();
}

void Frame::set_camera(const scene::Camera& camera) {
  camera_ = camera;
  samples_ = 0;
}

void Frame::add_sample() {
  shade_timer_.start();
  shade();
  shade_timer_.stop();
  accumulate_timer_.start();
  accumulate();
  accumulate_timer_.stop();
  timed_ = true;
  ++samples_;
}

void Frame::shade() {
  targets_->shade.bind();
  targets_->shade.clear();
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);

  // Uniform over the pixel: the box filter, one pixel wide.
  const glm::dvec2 point = r2_point(static_cast<std::uint32_t>(samples_), seeded_offset(seed_));
  const glm::vec2 jitter((2.0 * point - 1.0) / glm::dvec2(width_, height_));
  const gl::Buffer lights = lights_in_camera_space();
  lights.bind_storage(0);
  // A perspective projection takes its w from depth, an orthographic one is affine.
  const int orthographic = camera_.camera_to_clip[2][3] == 0.0 ? 1 : 0;

  const DeviceMaterial* bound = nullptr;
  for (const Draw& draw : draws_) {
    const gl::Program& program = draw.material->program();
    if (draw.material.get() != bound) {
      bound = draw.material.get();
      bound->bind();
      program.set("camera_to_clip", glm::mat4(camera_.camera_to_clip));
      program.set("jitter", jitter);
      program.set("light_count", static_cast<int>(lights_.size()));
      program.set("orthographic", orthographic);
    }
    const glm::dmat4 object_to_camera = camera_.world_to_camera * draw.object_to_world;
    const glm::dmat3 linear(object_to_camera);
    program.set("object_to_camera", glm::mat4(object_to_camera));
    program.set("normal_to_camera", glm::mat3(glm::transpose(glm::inverse(linear))));
    glFrontFace(glm::determinant(linear) < 0.0 ? GL_CW : GL_CCW);
    draw.mesh->draw();
  }
}

gl::Buffer Frame::lights_in_camera_space() const {
  const glm::dmat3 rotation(camera_.world_to_camera);
  std::vector<DeviceLight> lights;
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    const scene::DirectionalLight& light = lights_[i];
    glm::dvec3 to_light = glm::normalize(rotation * light.direction_to_light);
    if (light.angle > 0.0) {
      const glm::dvec2 offset = seeded_offset(seed_ + 0x10000U + static_cast<std::uint32_t>(i));
      to_light = sample_cone(to_light, light.angle, r4_point(static_cast<std::uint32_t>(samples_), offset));
    }
    lights.push_back({glm::vec4(to_light, 0.0), glm::vec4(light.irradiance, 0.0)});
  }
  return gl::Buffer(lights);
}

void Frame::accumulate() {
  targets_->accumulate.bind();
  if (samples_ == 0) targets_->accumulate.clear();
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  accumulate_program_.use();
  accumulate_program_.set("image", targets_->sample);
  full_screen_.draw();
}

void Frame::finish() const { glFinish(); }

void Frame::read(float* pixels) {
  if (samples_ == 0) {
    std::fill_n(pixels, static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * 4, 0.0F);
    return;
  }
  // The sample's texture is free between samples and has the right size and format.
  targets_->shade.bind();
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  resolve_program_.use();
  resolve_program_.set("sum", targets_->sum);
  resolve_program_.set("samples", static_cast<float>(samples_));
  full_screen_.draw();
  targets_->shade.read(pixels);
}

std::vector<PassTiming> Frame::timings() const {
  if (!timed_) return {};
  return {{"shade", shade_timer_.milliseconds()}, {"accumulate", accumulate_timer_.milliseconds()}};
}

}  // namespace mesograin::render
