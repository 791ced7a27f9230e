// Draws samples and accumulates them.
#include "render/frame.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>
#include <utility>

#include "base/error.h"
#include "gl/context_thread.h"
#include "render/sequence.h"

namespace mesograin::render {
namespace {

// Texels on a side of a shadow map.
constexpr int least_shadow_resolution = 256;
constexpr int most_shadow_resolution = 2048;

struct DeviceDirection {
  glm::vec4 to_light;  // w: angle
  glm::vec4 irradiance;
};

// How many directions of the world light one sample; where each costs a grain its own light map, one.
constexpr int most_world_directions = 4;

bool is_opaque(const DeviceMaterial& material) {
  return !material.light_maps() && !scene::traits_of(material.model()).mesh;
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
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
                       gl::ShaderSource({"passes/resolve.frag"}, {})),
      background_program_("background", gl::ShaderSource({"passes/full_screen.vert"}, {}),
                          gl::ShaderSource({"passes/background.frag"}, {})) {}

void Frame::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  targets_ = std::make_unique<Targets>(width, height);
  width_ = width;
  height_ = height;
  selection_.reset();
  if (!bake_) receivers_.clear();
  samples_ = 0;
}

void Frame::set_scene(scene::Scene scene) {
  cast_.reset();
  casters_.clear();
  content_ = std::make_unique<Content>(cache_, scene, std::move(*content_));
  version_ = content_->version();
  lighting_.set(scene);
  exchange_.set(*content_, scene);
  scene_ = std::move(scene);
  baked_.clear();
  bake_.reset();
  selection_.reset();
  receivers_.clear();
  samples_ = 0;
  cache_.prune();
}

void Frame::set_camera(const scene::Camera& camera) {
  camera_ = camera;
  selection_.reset();
  if (!bake_) receivers_.clear();
  samples_ = 0;
}

void Frame::set_bake(const Bake& bake) {
  if (bake.instances.empty()) throw Error("A bake needs at least one instance; got none.");
  for (const std::size_t instance : bake.instances) {
    if (instance >= scene_.instances.size())
      throw Error("A bake's instances must be among the scene's {}, counted from 0; got {}.", scene_.instances.size(),
                  instance);
    if (scene_.instances[instance].mesh->uvs().empty())
      throw Error("Baking needs UVs, and the mesh of instance {} has none: unwrap it first.", instance);
  }
  cast_.reset();
  casters_.clear();
  content_ = std::make_unique<Content>(cache_, scene_, std::move(*content_), bake.instances);
  version_ = content_->version();
  exchange_.set(*content_, scene_);
  baked_.clear();
  receivers_.clear();
  selection_.reset();
  for (const std::size_t instance : bake.instances) {
    const std::size_t index = content_->draw_of(instance);
    baked_.push_back(index);
    receivers_.grains.push_back(content_->receiver(content_->number(index)).ball);
  }
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
  for (const std::size_t baked : baked_) {
    const Draw& draw = content_->draws()[baked];
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

bool Frame::take_news() {
  cache_.take_news();
  const bool lit = exchange_.take_news();
  if (content_->version() == version_ && !lit) return false;
  version_ = content_->version();
  content_->take_news();
  samples_ = 0;
  return true;
}

void Frame::set_taps(int taps) {
  taps_ = taps;
  samples_ = 0;
}

void Frame::set_visibility(Visibility visibility) {
  if (visibility == Visibility::cast && !casting::available())
    throw Error("Rays cannot be cast on this machine: Embree needs AVX.");
  visibility_ = visibility;
  selection_.reset();
  receivers_.clear();
  samples_ = 0;
}

bool Frame::casts() const {
  if (content_->instances() == nullptr || visibility_ == Visibility::drawn) return false;
  return visibility_ == Visibility::cast ||
         (!gl::ContextThread::instance().device_info().hardware && casting::available());
}

bool Frame::reads_light_maps() const {
  const std::vector<Prototype>& prototypes = content_->instances()->prototypes();
  return std::any_of(prototypes.begin(), prototypes.end(),
                     [](const Prototype& prototype) { return prototype.light_maps != nullptr; });
}

bool Frame::knows_shadows_by_pixel() const {
  if (bake_ || !casts() || lighting_.eyes(sampled_lights_, content_->anchor()).size() > most_cast_lights) return false;
  const std::vector<Draw>& draws = content_->draws();
  const std::vector<InstanceGroup>& groups = content_->instances()->groups();
  return std::all_of(draws.begin(), draws.end(), [](const Draw& draw) { return is_opaque(*draw.material); }) &&
         std::all_of(groups.begin(), groups.end(),
                     [](const InstanceGroup& group) { return is_opaque(*group.material); });
}

void Frame::prepare_visibility() {
  if (casts() && !cast_) cast_ = std::make_unique<CastContent>(cache_, *content_);
  // Light maps are as fine as the largest grain in the picture.
  if (content_->instances() != nullptr && !selection_ && !(casts() && !reads_light_maps()))
    selection_ = std::make_unique<DeviceSelection>(
        content_->instances()->select(anchor_to_clip(*content_, camera_), width_, height_));
}

bool Frame::add_sample(const GoOn& go_on) {
  prepare_visibility();
  const std::vector<Draw>& draws = content_->draws();
  const bool own_maps =
      std::any_of(draws.begin(), draws.end(), [](const Draw& draw) { return draw.light_maps != nullptr; });
  sampled_lights_ = lighting_.sample(static_cast<std::uint32_t>(samples_), seed_, own_maps ? 1 : most_world_directions);
  shadows_by_pixel_ = knows_shadows_by_pixel();
  light_map_timer_.start();
  if (!update_light_maps(go_on)) return false;
  light_map_timer_.stop();
  shade_timer_.start();
  if (!shade(go_on)) return false;
  shade_timer_.stop();
  accumulate_timer_.start();
  accumulate();
  accumulate_timer_.stop();
  timed_ = true;
  ++samples_;
  return true;
}

double Frame::pixels_across(const Draw& draw) const {
  return bake_ ? std::max(width_, height_) : draw.pixels_across(camera_, width_, height_);
}

bool Frame::update_light_maps(const GoOn& go_on) {
  light_maps_drawn_ = 0;
  const auto program = [this](bool tessellated) -> const gl::Program& { return cache_.light_map_program(tessellated); };
  // So that what was asked for is drawn before it is asked whether to go on.
  const auto drawn = [&](int maps) {
    light_maps_drawn_ += maps;
    if (maps > 0) glFinish();
    return go_on();
  };
  const auto update = [&](Draw& draw) {
    if (!draw.light_maps) return true;
    const int resolution = light_map_resolution(pixels_across(draw), draw.mean_free_paths_across);
    std::vector<glm::dvec3> to_light;
    for (const LightDirection& light : lighting_.at(sampled_lights_, draw.centre)) to_light.push_back(light.to_light);
    return drawn(draw.light_maps->update(*draw.mesh, program, to_light, resolution));
  };
  if (bake_)
    return std::all_of(baked_.begin(), baked_.end(),
                       [&](std::size_t baked) { return update(content_->draws()[baked]); });
  for (Draw& draw : content_->draws())
    if (!update(draw)) return false;

  Instances* instances = content_->instances();
  if (instances == nullptr) return true;
  std::vector<glm::dvec3> to_light;
  for (const LightDirection& light : sampled_lights_.distant) to_light.push_back(light.to_light);
  for (std::size_t i = 0; i < instances->prototypes().size(); ++i) {
    Prototype& prototype = instances->prototypes()[i];
    if (!prototype.light_maps) continue;
    double mean_free_paths = 0.0;
    for (const InstanceGroup& group : instances->groups())
      if (group.prototype == i) mean_free_paths = std::max(mean_free_paths, group.mean_free_paths_across);
    const int resolution = light_map_resolution(selection_->selection.largest_pixels_across, mean_free_paths);
    LightMapDirections directions = instances->light_directions(i, to_light);
    // A light amid the heap meets its grains from everywhere.
    if (lighting_.any_local()) directions.ask_for_all();
    prototype.light_maps->update(prototype.details->mesh(0), program, directions, resolution, [&] { return drawn(1); });
    if (!go_on()) return false;
  }
  return true;
}

bool Frame::update_shadows(const GoOn& go_on) {
  shadows_drawn_ = content_->shadows() && !lighting_.eyes(sampled_lights_, content_->anchor()).empty();
  if (!shadows_drawn_) return true;
  const auto start = std::chrono::steady_clock::now();
  shadow_timer_.start();
  const bool whole = shadows_by_pixel_ ? update_cast_shadows(go_on) : update_shadow_maps(go_on);
  shadow_timer_.stop();
  shadow_milliseconds_ = milliseconds_since(start);
  return whole;
}

bool Frame::update_cast_shadows(const GoOn& go_on) {
  const std::vector<glm::vec4>* positions = &cast_surfaces_.positions();
  const std::vector<glm::vec4>* normals = &cast_surfaces_.normals();
  if (!content_->draws().empty()) {
    read_positions_.resize(positions->size());
    read_normals_.resize(normals->size());
    targets_->surfaces.read(&read_positions_.front().x, 0);
    targets_->surfaces.read(&read_normals_.front().x, 1);
    positions = &read_positions_;
    normals = &read_normals_;
  }
  return cast_shadows_.cast(*cast_, *content_, {*positions, *normals, {width_, height_}, viewer(content_->anchor())},
                            lighting_.eyes(sampled_lights_, content_->anchor()), go_on);
}

bool Frame::update_shadow_maps(const GoOn& go_on) {
  const std::vector<ShadowEye> eyes = lighting_.eyes(sampled_lights_, content_->anchor());
  if (receivers_.empty()) {
    casters_.clear();
    receivers_ = receivers(targets_->surfaces, width_, height_,
                           [this](std::size_t number) { return content_->receiver(number); });
  }
  // About a texel a pixel: the jitter makes them finer with every sample.
  const int resolution = std::clamp(static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(width_, height_)))),
                                    least_shadow_resolution, most_shadow_resolution);
  const glm::dvec2 jitter = r2_point(static_cast<std::uint32_t>(samples_), seeded_offset(seed_ + 0x20000U));
  std::vector<glm::vec2> texels;
  const auto draw = [&](const glm::dmat4& to_clip, const ShadowEye& eye, gl::TextureArray& maps, int layer,
                        const gl::Texture& depth) {
    if (casts()) {
      if (!cast_shadow_map(*cast_, *content_, to_clip, eye, resolution, texels, go_on)) return false;
      maps.upload(layer, GL_RG, GL_FLOAT, texels.data());
      return true;
    }
    const gl::Framebuffer target(maps, layer, depth);
    return draw_casters(cache_, *content_, casters(to_clip, eye, static_cast<std::size_t>(layer), resolution), to_clip,
                        eye, target, go_on);
  };
  return shadow_maps_.update(eyes, receivers_, content_->bounds(), content_->over_ground(), resolution, jitter, draw);
}

const DeviceSelection* Frame::casters(const glm::dmat4& anchor_to_clip, const ShadowEye& eye, std::size_t layer,
                                      int resolution) {
  if (content_->instances() == nullptr) return nullptr;
  if (casters_.size() <= layer) casters_.resize(layer + 1);
  Casters& known = casters_[layer];
  if (!known.selection || known.eye != eye)
    known = {eye,
             std::make_unique<DeviceSelection>(content_->instances()->select(anchor_to_clip, resolution, resolution))};
  return known.selection.get();
}

bool Frame::find_surfaces(const glm::vec2& jitter, std::size_t first, const GoOn& go_on) {
  const auto start = std::chrono::steady_clock::now();
  if (casts()) {
    if (first == 0 &&
        !cast_surfaces_.cast(*cast_, *content_, anchor_to_clip(*content_, camera_), jitter, {width_, height_}, go_on))
      return false;
    cast_surfaces_.upload(targets_->position, targets_->normal, targets_->depth, first);
  }
  targets_->surfaces.bind();
  glDisable(GL_BLEND);
  if (!casts() && first == 0) targets_->surfaces.clear();
  if (!casts() && first > 0) targets_->surfaces.clear_depth();
  const bool whole =
      draw_surfaces(cache_, *content_, casts() ? nullptr : selection_.get(), camera_, jitter, first, go_on);
  if (casts()) glFinish();
  surface_milliseconds_ = milliseconds_since(start);
  return whole;
}

bool Frame::shade(const GoOn& go_on) {
  // Uniform over the pixel: the box filter, one pixel wide.
  const glm::dvec2 point = r2_point(static_cast<std::uint32_t>(samples_), seeded_offset(seed_));
  const glm::vec2 jitter((2.0 * point - 1.0) / glm::dvec2(width_, height_));
  if (bake_) {
    if (!update_shadows(go_on)) return false;
    targets_->shade.bind();
    targets_->shade.clear();
    glDisable(GL_BLEND);
    shade_unwrapped(jitter);
    return true;
  }
  const Instances* instances = content_->instances();
  const std::size_t units = (instances != nullptr ? instances->groups().size() : 0) + content_->draws().size();
  for (std::size_t first = 0; first < units || first == 0; first += most_in_stencil) {
    if (!find_surfaces(jitter, first, go_on)) return false;
    if (first == 0) {
      if (!update_shadows(go_on)) return false;
      // Rays are not the device's work.
      if (casts()) shade_timer_.start();
      targets_->shade.bind();
      targets_->shade.clear_colour();
      glDisable(GL_BLEND);
      if (lighting_.world().seen) draw_background(jitter);
    }
    glDisable(GL_BLEND);
    shade_surfaces(first);
  }
  return true;
}

void Frame::draw_background(const glm::vec2& jitter) {
  glDisable(GL_DEPTH_TEST);
  background_program_.use();
  const glm::dmat4 world_to_clip = camera_.camera_to_clip * glm::dmat4(glm::dmat3(camera_.world_to_camera));
  background_program_.set("clip_to_world", glm::mat4(glm::inverse(world_to_clip)));
  background_program_.set("jitter", jitter);
  background_program_.set("size", glm::vec2(width_, height_));
  set_world(background_program_);
  full_screen_.draw();
}

void Frame::shade_surfaces(std::size_t first) {
  targets_->shade.bind();
  glEnable(GL_STENCIL_TEST);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glEnable(GL_SCISSOR_TEST);
  glFrontFace(GL_CCW);
  const Instances* instances = content_->instances();
  const std::size_t groups = instances != nullptr ? instances->groups().size() : 0;
  const std::size_t units = groups + content_->draws().size();
  for (std::size_t i = first; i < std::min(first + most_in_stencil, units); ++i) {
    const bool instanced = i < groups;
    const DeviceMaterial& material =
        instanced ? *instances->groups()[i].material : *content_->draws()[i - groups].material;
    const gl::Program& program = cache_.shading(material, shading(material, false, instanced));
    material.bind(program);
    set_common(program);
    if (instanced) {
      set_group(program, instances->groups()[i]);
      glScissor(0, 0, width_, height_);
    } else {
      const Draw& draw = content_->draws()[i - groups];
      set_draw(program, draw);
      confine_to(draw);
    }
    program.set("surface_position", targets_->position);
    program.set("surface_normal", targets_->normal);
    glStencilFunc(GL_EQUAL, static_cast<GLint>(i - first + 1), most_in_stencil);
    full_screen_.draw();
  }
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
}

void Frame::shade_unwrapped(const glm::vec2& jitter) {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  for (const std::size_t baked : baked_) {
    const Draw& draw = content_->draws()[baked];
    const gl::Program& program = cache_.shading(*draw.material, shading(*draw.material, true, false));
    draw.material->bind(program);
    set_common(program);
    set_draw(program, draw);
    const glm::dmat4 object_to_grain = draw.object_to_grain();
    program.set("jitter", jitter);
    program.set("from_camera", static_cast<int>(bake_ == ViewFrom::active_camera));
    program.set("instance", static_cast<int>(content_->number(baked)));
    program.set("object_to_grain", glm::mat4(object_to_grain));
    program.set("normal_to_grain", glm::mat3(glm::transpose(glm::inverse(glm::dmat3(object_to_grain)))));
    draw.mesh->draw();
  }
  glDisable(GL_DEPTH_TEST);
}

Shading Frame::shading(const DeviceMaterial& material, bool unwrapped, bool instanced) const {
  const Shadows shadows = !content_->shadows() ? Shadows::none : shadows_by_pixel_ ? Shadows::cast : Shadows::maps;
  return {
      unwrapped, instanced, shadows, exchange_.any(), lighting_.world().shines(), lights_at_place(material, instanced)};
}

bool Frame::lights_at_place(const DeviceMaterial& material, bool instanced) const {
  return lighting_.any_local() && (instanced || !material.light_maps());
}

void Frame::set_lights(const gl::Program& program, const std::vector<LightDirection>& directions,
                       const glm::dvec3& origin) {
  std::vector<DeviceDirection> device;
  device.reserve(directions.size());
  for (const LightDirection& light : directions)
    device.push_back({glm::vec4(light.to_light, light.angle), glm::vec4(light.irradiance, 0.0)});
  device_directions_.emplace(device);
  device_directions_->bind_storage(0);
  program.set("light_count", static_cast<int>(device.size()));
  if (!lighting_.any_local()) return;
  device_lights_.emplace(lighting_.device_local(origin));
  device_lights_->bind_storage(6);
  const std::vector<glm::vec2> randoms(sampled_lights_.randoms.begin(), sampled_lights_.randoms.end());
  device_randoms_.emplace(randoms);
  device_randoms_->bind_storage(7);
  program.set("local_light_count", static_cast<int>(randoms.size()));
  program.set("distant_light_count", static_cast<int>(sampled_lights_.distant.size()));
}

void Frame::set_world(const gl::Program& program) const {
  program.set("world_radiance", glm::vec3(lighting_.world().radiance));
  program.set("has_image", static_cast<int>(lighting_.world_image() != nullptr));
  program.set("world_to_image", glm::mat3(lighting_.world().world_to_image));
  if (lighting_.world_image() != nullptr) program.set("world_image", *lighting_.world_image());
}

void Frame::set_common(const gl::Program& program) const {
  if (lighting_.world().shines()) set_world(program);
  program.set("sample_index", samples_);
  program.set("taps", taps_);
  if (shadows_drawn_ && shadows_by_pixel_) cast_shadows_.bind(program);
  if (shadows_drawn_ && !shadows_by_pixel_) shadow_maps_.bind(program);
  if (exchange_.any()) exchange_.bind();
}

void Frame::set_viewer(const gl::Program& program, const glm::dvec3& origin) const {
  program.set("viewer", viewer(origin));
}

glm::vec4 Frame::viewer(const glm::dvec3& origin) const {
  const glm::dmat4 camera_to_world = glm::inverse(camera_.world_to_camera);
  // A perspective projection takes its w from depth; an orthographic one is affine and sees along one direction.
  const bool orthographic = camera_.camera_to_clip[2][3] == 0.0;
  return orthographic ? glm::vec4(glm::normalize(glm::dvec3(camera_to_world[2])), 0.0)
                      : glm::vec4(glm::dvec3(camera_to_world[3]) - origin, 1.0);
}

void Frame::set_draw(const gl::Program& program, const Draw& draw) {
  const bool at_place = lights_at_place(*draw.material, false);
  set_lights(program, at_place ? sampled_lights_.distant : lighting_.at(sampled_lights_, draw.centre), draw.centre);
  if (draw.light_maps) draw.light_maps->bind(program);
  program.set("grain_reach", static_cast<float>(draw.reach));
  program.set("grain_to_prototype", glm::mat3(draw.grain_to_prototype));
  program.set("place_of_grain", glm::vec3(draw.centre - content_->anchor()));
  program.set("object_number",
              static_cast<int>(content_->object_number(static_cast<std::size_t>(&draw - content_->draws().data()))));
  program.set("shades_itself", static_cast<int>(content_->shades_itself(draw)));
  set_viewer(program, draw.centre);
}

void Frame::set_group(const gl::Program& program, const InstanceGroup& group) {
  set_lights(program, sampled_lights_.distant, content_->anchor());
  const Instances& instances = *content_->instances();
  const Prototype& prototype = instances.prototypes()[group.prototype];
  instances.bind();
  if (group.material->light_maps()) prototype.light_maps->bind(program);
  program.set("typical_scale", static_cast<float>(group.typical_scale));
  program.set("unstretch", group.unstretch);
  program.set("grain_reach", static_cast<float>(prototype.mesh->reach() * group.typical_scale));
  program.set("shades_itself", static_cast<int>(instances.shades_itself(group)));
  set_viewer(program, content_->anchor());
}

void Frame::confine_to(const Draw& draw) const {
  const glm::dmat4 to_clip = camera_.camera_to_clip * (camera_.world_to_camera * draw.object_to_world);
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

void Frame::read_surfaces(float* positions, float* normals) {
  if (bake_) throw Error("A bake has no view whose surfaces could be read: set a camera and a scene without bake.");
  prepare_visibility();
  find_surfaces(glm::vec2(0.0F), 0, [] { return true; });
  const std::size_t count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  const glm::dvec4 eye(viewer(glm::dvec3(0.0)));
  std::vector<glm::vec4> on_triangle(count);
  std::vector<glm::vec4> facing(count);
  targets_->surfaces.read(glm::value_ptr(on_triangle.front()), 0);
  targets_->surfaces.read(glm::value_ptr(facing.front()), 1);
  for (std::size_t i = 0; i < count; ++i) {
    glm::vec4 position(0.0F);
    glm::vec3 normal(0.0F);
    if (facing[i].w != 0.0F) {
      const auto number = static_cast<std::size_t>(std::abs(facing[i].w)) - 1;
      const glm::dvec3 origin = content_->anchor() + glm::dvec3(content_->receiver(number).ball);
      normal = glm::vec3(facing[i]);
      const glm::dvec3 place = glm::dvec3(on_triangle[i]) + static_cast<double>(on_triangle[i].w) * glm::dvec3(normal);
      position = glm::vec4(glm::vec3(origin + place), 1.0F);
      if (facing[i].w < 0.0F && glm::dot(glm::dvec3(normal), glm::dvec3(eye) - eye.w * (origin + place)) < 0.0)
        normal = -normal;
    }
    // The device's rows begin at the bottom.
    const auto width = static_cast<std::size_t>(width_);
    const std::size_t pixel = (static_cast<std::size_t>(height_) - 1 - i / width) * width + i % width;
    std::copy_n(glm::value_ptr(position), 4, positions + 4 * pixel);
    std::copy_n(glm::value_ptr(normal), 3, normals + 3 * pixel);
  }
}

std::vector<PassTiming> Frame::timings() const {
  if (!timed_) return {};
  std::vector<PassTiming> passes;
  if (light_maps_drawn_ > 0) passes.push_back({"light_maps", light_map_timer_.milliseconds()});
  if (casts()) {
    passes.push_back({"surfaces", surface_milliseconds_});
    if (shadows_drawn_) passes.push_back({"shadows", shadow_milliseconds_});
    passes.push_back({"shade", shade_timer_.milliseconds()});
    passes.push_back({"accumulate", accumulate_timer_.milliseconds()});
    return passes;
  }
  // The shadows are drawn once it is known what is seen, and so amid the rest.
  const double shadows = shadows_drawn_ ? shadow_timer_.milliseconds() : 0.0;
  if (shadows_drawn_) passes.push_back({"shadow_maps", shadows});
  passes.push_back({"shade", shade_timer_.milliseconds() - shadows});
  passes.push_back({"accumulate", accumulate_timer_.milliseconds()});
  return passes;
}

Statistics Frame::statistics() const {
  Statistics result;
  if (exchange_.any()) result.exchange = exchange_.statistics();
  if (content_->instances() == nullptr) return result;
  result.instances = content_->instances()->count();
  if (samples_ == 0 || bake_) return result;
  if (casts()) {
    result.cast = result.instances;
    result.seen = cast_surfaces_.seen();
  } else {
    result.drawn = selection_->selection.instances.size();
  }
  return result;
}

}  // namespace mesograin::render
