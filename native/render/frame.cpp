// Draws samples and accumulates them.
#include "render/frame.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>
#include <utility>

#include "render/sequence.h"
#include "scene/error.h"

namespace mesograin::render {
namespace {

// How many draws the stencil's bits tell apart, beside no draw.
constexpr GLuint stencil_bits = 0xFF;
constexpr std::size_t most_in_stencil = stencil_bits;

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
    : position(GL_RGBA32F, width, height),
      normal(GL_RGBA32F, width, height),
      depth(GL_DEPTH32F_STENCIL8, width, height),
      sample(GL_RGBA32F, width, height),
      sum(GL_RGBA32F, width, height),
      surfaces({&position, &normal}, &depth),
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

glm::dmat4 Frame::Draw::object_to_grain() const {
  glm::dmat4 matrix = object_to_world;
  matrix[3] -= glm::dvec4(centre, 0.0);
  return matrix;
}

Frame::Draw Frame::make_draw(const scene::Instance& instance, std::size_t index) {
  const glm::dvec3 lower(instance.mesh->lower());
  const glm::dvec3 upper(instance.mesh->upper());
  const glm::dmat3 linear(instance.object_to_world);
  const glm::dvec3 half = 0.5 * (upper - lower);
  Draw draw;
  draw.instance = index;
  draw.source = instance.mesh;
  draw.mesh = cache_.mesh(instance.mesh);
  draw.object_to_world = instance.object_to_world;
  draw.centre = glm::dvec3(instance.object_to_world * glm::dvec4(0.5 * (lower + upper), 1.0));
  draw.radius = glm::length(
      glm::dvec3(glm::length(linear[0] * half.x), glm::length(linear[1] * half.y), glm::length(linear[2] * half.z)));
  const glm::dmat3 squared = glm::transpose(linear) * linear;
  double stretch_squared = 0.0;  // a bound, exact for rotations, scales and mirrors
  for (int row = 0; row < 3; ++row)
    stretch_squared =
        std::max(stretch_squared, std::abs(squared[0][row]) + std::abs(squared[1][row]) + std::abs(squared[2][row]));
  draw.reach = instance.mesh->reach() * std::sqrt(stretch_squared);
  const scene::Material& material = instance.material;
  // The cube root takes a mirrored or stretched grain for the one of the same volume.
  draw.material = cache_.material(
      material, std::max(instance.mesh->equivalent_radius() * std::cbrt(std::abs(glm::determinant(linear))), 1e-30));
  draw.program = &cache_.shading(*draw.material, Shading::seen);
  const glm::dvec3 reduced = material.scale * (material.sigma_a + (1.0 - material.g) * material.sigma_s);
  draw.mean_free_paths_across = 2.0 * draw.radius * std::max({reduced.r, reduced.g, reduced.b});
  if (draw.material->light_maps()) draw.light_maps = take_light_maps(draw);
  return draw;
}

glm::dmat4 Frame::object_to_clip(const Draw& draw) const {
  return camera_.camera_to_clip * (camera_.world_to_camera * draw.object_to_world);
}

std::unique_ptr<LightMaps> Frame::take_light_maps(const Draw& wanted) {
  // Maps as fine as another material needed them would show this one as it was never drawn by itself.
  const auto least = [](const Draw& draw) { return light_map_resolution(0.0, draw.mean_free_paths_across); };
  const glm::dmat4 object_to_grain = wanted.object_to_grain();
  for (Draw& draw : draws_)
    if (draw.light_maps && draw.light_maps->are_of(wanted.source, object_to_grain) && least(draw) == least(wanted))
      return std::move(draw.light_maps);
  return std::make_unique<LightMaps>(wanted.source, object_to_grain);
}

void Frame::set_scene(scene::Scene scene) {
  std::vector<Draw> draws;
  for (const scene::Instance& instance : scene.instances) draws.push_back(make_draw(instance, draws.size()));
  // Neighbours that share a material need it bound once.
  std::stable_sort(draws.begin(), draws.end(),
                   [](const Draw& a, const Draw& b) { return a.material.get() < b.material.get(); });
  draws_ = std::move(draws);
  lights_ = std::move(scene.lights);
  bake_.reset();
  samples_ = 0;
  cache_.prune();
}

void Frame::set_camera(const scene::Camera& camera) {
  camera_ = camera;
  samples_ = 0;
}

void Frame::set_bake(const Bake& bake) {
  if (bake.instances.empty()) throw Error("A bake needs at least one instance; got none.");
  std::vector<const gl::Program*> programs(draws_.size(), nullptr);
  for (const std::size_t instance : bake.instances) {
    const auto draw =
        std::find_if(draws_.begin(), draws_.end(), [&](const Draw& each) { return each.instance == instance; });
    if (draw == draws_.end())
      throw Error("A bake's instances must be among the scene's {}, counted from 0; got {}.", draws_.size(), instance);
    if (draw->source->uvs().empty())
      throw Error("Baking needs UVs, and the mesh of instance {} has none: unwrap it first.", instance);
    programs[static_cast<std::size_t>(draw - draws_.begin())] = &cache_.shading(*draw->material, Shading::unwrapped);
  }
  for (std::size_t i = 0; i < draws_.size(); ++i) draws_[i].program = programs[i];
  bake_ = bake.view_from;
  samples_ = 0;
}

UvUse Frame::uv_use() {
  if (!bake_) throw Error("The use of UVs is known of a bake only: call set_bake first.");
  // The sample's texture is free between samples.
  targets_->shade.bind();
  targets_->shade.clear();
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  const gl::Program& program = cache_.count_program();
  program.use();
  program.set("jitter", glm::vec2(0.0F));
  UvUse use;
  const auto outside = [](const glm::vec2& uv) { return glm::any(glm::notEqual(uv, glm::clamp(uv, 0.0F, 1.0F))); };
  for (const Draw& draw : draws_) {
    if (draw.program == nullptr) continue;
    draw.mesh->draw();
    const std::vector<glm::vec2>& uvs = draw.source->uvs();
    for (const glm::uvec3& triangle : draw.source->triangles())
      if (outside(uvs[triangle.x]) || outside(uvs[triangle.y]) || outside(uvs[triangle.z])) ++use.triangles_outside;
  }
  std::vector<glm::vec4> counts(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  targets_->shade.read(glm::value_ptr(counts.front()));
  for (const glm::vec4& count : counts) {
    if (count.x > 0.0F) ++use.texels;
    if (count.x > 1.0F) ++use.overlapping;
  }
  return use;
}

void Frame::set_taps(int taps) {
  taps_ = taps;
  samples_ = 0;
}

void Frame::add_sample() {
  const std::vector<glm::dvec3> to_light = sample_light_directions();
  light_map_timer_.start();
  update_light_maps(to_light);
  light_map_timer_.stop();
  shade_timer_.start();
  shade(to_light);
  shade_timer_.stop();
  accumulate_timer_.start();
  accumulate();
  accumulate_timer_.stop();
  timed_ = true;
  ++samples_;
}

std::vector<glm::dvec3> Frame::sample_light_directions() const {
  std::vector<glm::dvec3> directions;
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    const scene::DirectionalLight& light = lights_[i];
    glm::dvec3 to_light = glm::normalize(light.direction_to_light);
    if (light.angle > 0.0) {
      const glm::dvec2 offset = seeded_offset(seed_ + 0x10000U + static_cast<std::uint32_t>(i));
      to_light = sample_cone(to_light, light.angle, r4_point(static_cast<std::uint32_t>(samples_), offset));
    }
    directions.push_back(to_light);
  }
  return directions;
}

double Frame::pixels_across(const Draw& draw) const {
  const double largest = std::max(width_, height_);
  if (bake_) return largest;
  const glm::dvec4 centre = camera_.world_to_camera * glm::dvec4(draw.centre, 1.0);
  // w of a point at the centre's depth; a grain that the camera is inside of counts as filling the picture.
  const double w = camera_.camera_to_clip[2][3] * centre.z + camera_.camera_to_clip[3][3];
  if (w <= 0.0) return largest;
  const double half_image = draw.radius / w;
  return std::min(largest, std::max(half_image * std::abs(camera_.camera_to_clip[0][0]) * width_,
                                    half_image * std::abs(camera_.camera_to_clip[1][1]) * height_));
}

void Frame::update_light_maps(const std::vector<glm::dvec3>& to_light) {
  light_maps_drawn_ = 0;
  const auto program = [this](bool tessellated) -> const gl::Program& { return cache_.light_map_program(tessellated); };
  for (const Draw& draw : draws_) {
    if (!draw.light_maps || draw.program == nullptr) continue;
    const int resolution = light_map_resolution(pixels_across(draw), draw.mean_free_paths_across);
    light_maps_drawn_ += draw.light_maps->update(*draw.mesh, program, to_light, resolution);
  }
}

void Frame::shade(const std::vector<glm::dvec3>& to_light) {
  targets_->shade.bind();
  targets_->shade.clear();
  glDisable(GL_BLEND);

  // Uniform over the pixel: the box filter, one pixel wide.
  const glm::dvec2 point = r2_point(static_cast<std::uint32_t>(samples_), seeded_offset(seed_));
  const glm::vec2 jitter((2.0 * point - 1.0) / glm::dvec2(width_, height_));
  std::vector<DeviceLight> device_lights;
  for (std::size_t i = 0; i < lights_.size(); ++i)
    device_lights.push_back({glm::vec4(to_light[i], lights_[i].angle), glm::vec4(lights_[i].irradiance, 0.0)});
  const gl::Buffer lights(device_lights);
  lights.bind_storage(0);

  if (bake_) {
    shade_unwrapped(jitter);
    return;
  }
  for (std::size_t first = 0; first < draws_.size(); first += most_in_stencil) {
    draw_surfaces(first, jitter);
    shade_surfaces(first);
  }
}

void Frame::draw_surfaces(std::size_t first, const glm::vec2& jitter) {
  targets_->surfaces.bind();
  targets_->surfaces.clear_depth();
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  const gl::Program& program = cache_.surface_program();
  program.use();
  program.set("jitter", jitter);
  for (std::size_t i = 0; i < draws_.size(); ++i) {
    const Draw& draw = draws_[i];
    const bool told = i >= first && i - first < most_in_stencil;
    glStencilFunc(GL_ALWAYS, told ? static_cast<GLint>(i - first + 1) : 0, stencil_bits);
    const glm::dmat4 object_to_grain = draw.object_to_grain();
    const glm::dmat3 linear(object_to_grain);
    program.set("object_to_clip", glm::mat4(object_to_clip(draw)));
    program.set("object_to_grain", glm::mat4(object_to_grain));
    program.set("normal_to_grain", glm::mat3(glm::transpose(glm::inverse(linear))));
    const glm::dmat3 to_camera = glm::dmat3(camera_.world_to_camera) * linear;
    glFrontFace(glm::determinant(to_camera) < 0.0 ? GL_CW : GL_CCW);
    draw.mesh->draw();
  }
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_DEPTH_TEST);
}

void Frame::shade_surfaces(std::size_t first) {
  targets_->shade.bind();
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glEnable(GL_SCISSOR_TEST);
  glFrontFace(GL_CCW);
  for (std::size_t i = first; i < std::min(first + most_in_stencil, draws_.size()); ++i) {
    const Draw& draw = draws_[i];
    set_shading(draw);
    draw.program->set("surface_position", targets_->position);
    draw.program->set("surface_normal", targets_->normal);
    glStencilFunc(GL_EQUAL, static_cast<GLint>(i - first + 1), stencil_bits);
    confine_to(draw);
    full_screen_.draw();
  }
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
}

void Frame::shade_unwrapped(const glm::vec2& jitter) {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  for (const Draw& draw : draws_) {
    if (draw.program == nullptr) continue;
    set_shading(draw);
    const glm::dmat4 object_to_grain = draw.object_to_grain();
    draw.program->set("jitter", jitter);
    draw.program->set("from_camera", static_cast<int>(bake_ == ViewFrom::active_camera));
    draw.program->set("object_to_grain", glm::mat4(object_to_grain));
    draw.program->set("normal_to_grain", glm::mat3(glm::transpose(glm::inverse(glm::dmat3(object_to_grain)))));
    draw.mesh->draw();
  }
  glDisable(GL_DEPTH_TEST);
}

void Frame::set_shading(const Draw& draw) const {
  const gl::Program& program = *draw.program;
  draw.material->bind(program);
  if (draw.light_maps) draw.light_maps->bind(program);
  program.set("light_count", static_cast<int>(lights_.size()));
  program.set("sample_index", samples_);
  program.set("taps", taps_);
  program.set("grain_reach", static_cast<float>(draw.reach));
  const glm::dmat4 camera_to_world = glm::inverse(camera_.world_to_camera);
  // A perspective projection takes its w from depth; an orthographic one is affine and sees along one direction.
  const bool orthographic = camera_.camera_to_clip[2][3] == 0.0;
  program.set("viewer", orthographic ? glm::vec4(glm::normalize(glm::dvec3(camera_to_world[2])), 0.0)
                                     : glm::vec4(glm::dvec3(camera_to_world[3]) - draw.centre, 1.0));
}

void Frame::confine_to(const Draw& draw) const {
  const glm::dmat4 to_clip = object_to_clip(draw);
  const glm::dvec2 size(width_, height_);
  glm::dvec2 lower = size;
  glm::dvec2 upper(0.0);
  for (unsigned corner = 0; corner < 8; ++corner) {
    const glm::bvec3 high((corner & 1U) != 0, (corner & 2U) != 0, (corner & 4U) != 0);
    const glm::dvec4 clip =
        to_clip * glm::dvec4(glm::mix(glm::dvec3(draw.source->lower()), glm::dvec3(draw.source->upper()), high), 1.0);
    if (!(clip.w > 0.0)) {
      glScissor(0, 0, width_, height_);
      return;
    }
    const glm::dvec2 pixel = (0.5 * glm::dvec2(clip) / clip.w + 0.5) * size;
    lower = glm::min(lower, pixel);
    upper = glm::max(upper, pixel);
  }
  // The jitter moves the picture by up to half a pixel.
  const glm::ivec2 first(glm::clamp(glm::floor(lower - 1.0), glm::dvec2(0.0), size));
  const glm::ivec2 end(glm::clamp(glm::ceil(upper + 1.0), glm::dvec2(0.0), size));
  glScissor(first.x, first.y, std::max(end.x - first.x, 0), std::max(end.y - first.y, 0));
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
  std::vector<PassTiming> passes;
  if (light_maps_drawn_ > 0) passes.push_back({"light_maps", light_map_timer_.milliseconds()});
  passes.push_back({"shade", shade_timer_.milliseconds()});
  passes.push_back({"accumulate", accumulate_timer_.milliseconds()});
  return passes;
}

}  // namespace mesograin::render
