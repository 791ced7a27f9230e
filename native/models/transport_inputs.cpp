// Packs stored transport into texels.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "base/error.h"
#include "models/dielectric_inputs.h"
#include "models/fewer_nodes.h"
#include "models/inputs_of_models.h"
#include "models/light_about_inputs.h"
#include "models/lobe_maps.h"
#include "models/prototype_inputs.h"
#include "physics/half_space/dielectric_surface.h"
#include "physics/physics.h"
#include "transport/octahedron.h"
#include "transport/stored_transport.h"
#include "transport/surface.h"

namespace mesograin::models {
namespace {

using transport::StoredTransport;

constexpr int terms_a_texel = 4;
// As shaders/models/stored_products.glsl has it, of a grey medium and of another, whose channels share terms.
struct Counts {
  int fewest;
  int many;
  int more;
  int leading_blocks;  // the last, for terms are kept by how much is seen of them
  int lobe_side;       // texels along a side of a map of lobes
};
constexpr Counts grey_counts{16, 24, 36, 2, transport::octahedron_side};
// Each term has maps for all channels: a little fewer texels leave room for four terms more, of which more is seen.
constexpr Counts shared_counts{20, 32, 32, 1, 24};

const Counts& counts_of(const StoredTransport& stored) { return stored.channels == 1 ? grey_counts : shared_counts; }

// What is divided by is not 0.
constexpr double least_albedo = 1e-9;

// Mean free paths across a grain that nothing to be seen crosses unscattered. Its edges, and without refraction its
// rim, are thin, however thick it is: one that nothing were seen through would be lined in black.
constexpr double most_clear = 60.0;
// Of what a body may be across: where its mean chord is shorter, light leaves it and enters it again across a hollow.
constexpr double hollow = 0.5;

// Whether light is followed through single facets: into a thinner medium they would reflect much of it wholly, to one
// another.
bool has_facets(const scene::Material& material) { return physics::has_rough_surface(material) && material.eta > 1.0; }

// What is stored is told for steps of roughness: within one nothing is traced anew.
constexpr double alpha_step = 0.125;

// The medium that is similar to the material's and scatters isotropically (van de Hulst 1980, section 14.1.3).
transport::StoredMedium stored_medium(const scene::Material& material) {
  const glm::dvec3 sigma_s = material.scale * (1.0 - material.g) * material.sigma_s;
  transport::StoredMedium medium;
  medium.sigma_t = material.scale * material.sigma_a + sigma_s;
  for (int channel = 0; channel < 3; ++channel)
    medium.albedo[channel] = sigma_s[channel] > 0.0 ? sigma_s[channel] / medium.sigma_t[channel] : 0.0;
  medium.eta = material.boundary == scene::Boundary::dielectric ? material.eta : 1.0;
  if (has_facets(material)) medium.alpha = alpha_step * std::round(material.roughness / alpha_step);
  return medium;
}

// Beyond this g, forwards or backwards, similarity is more wrong than walks cost: see docs/shapes.md.
constexpr double most_similar_g = 0.1;

bool is_walked(const scene::Material& material) { return std::abs(material.g) > most_similar_g; }

// Nearer to -1 the phase function is not known to float's last digits.
constexpr double least_g = -0.95;

// 1 - cosine of 15 degrees. Light that the peak has turned by less counts as unscattered once it is turned by more.
constexpr double peak_versine = 0.034;

// What of a Henyey-Greenstein function within peak_versine is more than at its edge; backwards there is no such peak.
void add_peak(double g, MaterialInputs& inputs) {
  const double rest = 1.0 - g;
  if (g < 0.0) {
    inputs.uniforms["forward.peak_versine"] = 0.0F;
    inputs.uniforms["forward.edge"] = static_cast<float>(physics::henyey_greenstein(0.0, g, rest));
    inputs.uniforms["forward.within"] = 0.0F;
    inputs.uniforms["forward.peak"] = 0.0F;
    inputs.uniforms["forward.wide_g"] = static_cast<float>(g);
    return;
  }
  const double at_edge = std::sqrt(rest * rest + 2.0 * g * peak_versine);
  const double edge = physics::henyey_greenstein(peak_versine, g, rest);
  const double within = rest * (1.0 + g) / (2.0 * g) * (1.0 / rest - 1.0 / at_edge);
  const double peak = within - 2.0 * physics::PI * peak_versine * edge;
  // The integral of 1 - cosine over the peak.
  const double turned = rest * (1.0 + g) / (4.0 * g * g) * (at_edge + rest * rest / at_edge - 2.0 * rest) -
                        physics::PI * peak_versine * peak_versine * edge;
  inputs.uniforms["forward.peak_versine"] = static_cast<float>(peak_versine);
  inputs.uniforms["forward.edge"] = static_cast<float>(edge);
  inputs.uniforms["forward.within"] = static_cast<float>(within);
  inputs.uniforms["forward.peak"] = static_cast<float>(peak);
  inputs.uniforms["forward.wide_g"] = static_cast<float>(1.0 - (rest - turned) / (1.0 - peak));
}

// Light falls off more slowly in the media that stand for a walk's own after so many wide scatterings: that shows
// through a grain of many mean free paths, for from behind a ball 20 of them across was 6 % too bright after four, and
// 25 in its middle. What of a mean chord counts as many.
constexpr double many_free_paths = 8.0;
constexpr int exact_where_many = 6;
constexpr int exact_where_few = 4;

// Of the medium itself, per unit of the body.
void add_forward(const scene::Material& material, const StoredTransport& stored, MaterialInputs& inputs) {
  const glm::dvec3 similar_albedo = stored_medium(material).albedo;
  inputs.uniforms["forward.sigma_s"] = glm::vec3(stored.unit * material.scale * material.sigma_s);
  inputs.uniforms["forward.sigma_a"] = glm::vec3(stored.unit * material.scale * material.sigma_a);
  inputs.uniforms["forward.similar_albedo"] = glm::vec3(glm::max(similar_albedo, least_albedo));
  const double g = std::clamp(material.g, least_g, double{physics::HENYEY_GREENSTEIN_LARGEST_G});
  inputs.uniforms["forward.g"] = static_cast<float>(g);
  inputs.uniforms["forward.one_minus_g"] = static_cast<float>(1.0 - g);
  add_peak(g, inputs);
  const glm::dvec3 thickness = stored.mean_chord * stored.unit * material.scale * (material.sigma_s + material.sigma_a);
  inputs.uniforms["forward.exact_scatterings"] =
      std::max({thickness.r, thickness.g, thickness.b}) > many_free_paths ? exact_where_many : exact_where_few;
}

using FourNumbers = std::array<float, terms_a_texel>;

// Each block is four terms, a component each.
struct Blocks {
  Blocks(const StoredTransport& stored, int terms)
      : count(terms / terms_a_texel),
        leading(counts_of(stored).leading_blocks),
        left_out(static_cast<std::size_t>(stored.terms - terms)) {}

  bool leads(int block) const { return block >= count - leading; }

  std::size_t term(int block, std::size_t component) const {
    return left_out + static_cast<std::size_t>(block) * terms_a_texel + component;
  }

  int count;
  int leading;
  std::size_t left_out;  // the least
};

// The largest value of each of a block's terms, over which a byte is enough for them: the lobes are multiplied by it.
FourNumbers scales(const StoredTransport& stored, const Blocks& blocks, int block) {
  FourNumbers largest{};
  for (std::size_t component = 0; component < terms_a_texel; ++component) {
    float& scale = largest[component];
    const std::size_t first = blocks.term(block, component) * stored.nodes();
    for (std::size_t node = 0; node < stored.nodes(); ++node)
      scale = std::max(scale, std::abs(stored.sources[first + node]));
    if (scale == 0.0F) scale = 1.0F;
  }
  return largest;
}

// Blocks of nodes, one behind the other along z.
Volume sources_volume(const StoredTransport& stored, const Blocks& blocks) {
  Volume volume{stored.size.x, stored.size.y, stored.size.z * blocks.count, terms_a_texel, {}, true};
  volume.texels.reserve(stored.nodes() * static_cast<std::size_t>(volume.channels) *
                        static_cast<std::size_t>(blocks.count));
  for (int block = 0; block < blocks.count; ++block) {
    const FourNumbers scale = scales(stored, blocks, block);
    for (std::size_t node = 0; node < stored.nodes(); ++node)
      for (std::size_t component = 0; component < terms_a_texel; ++component)
        volume.texels.push_back(stored.sources[blocks.term(block, component) * stored.nodes() + node] /
                                scale[component]);
  }
  return volume;
}

// Which way the distance from the surface grows, at the nodes that light is stored at, smoothed across by the
// neighbours (Sobel's operator); beyond the box nothing is known.
Volume smooth_slopes_volume(const StoredTransport& stored) {
  const glm::ivec3 last = stored.size - 1;
  const glm::ivec3 surface = transport::surface_size(stored.size);
  const auto distance_at = [&](const glm::ivec3& node) {
    const glm::ivec3 at = transport::surface_finer * glm::clamp(node, glm::ivec3(0), last);
    const int index = (at.z * surface.y + at.y) * surface.x + at.x;
    return stored.distances[static_cast<std::size_t>(index)];
  };
  const auto slope = [&](const glm::ivec3& node, int axis) {
    glm::ivec3 before = node, after = node;
    before[axis] = std::max(node[axis] - 1, 0);
    after[axis] = std::min(node[axis] + 1, last[axis]);
    const float apart = static_cast<float>(after[axis] - before[axis]) * stored.spacing[axis];
    float rise = 0.0F;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j) {
        glm::ivec3 aside(0);
        aside[(axis + 1) % 3] = i;
        aside[(axis + 2) % 3] = j;
        const int weight = (2 - std::abs(i)) * (2 - std::abs(j));
        rise += static_cast<float>(weight) / 16.0F * (distance_at(after + aside) - distance_at(before + aside));
      }
    return rise / apart;
  };
  Volume volume{stored.size.x, stored.size.y, stored.size.z, 3, {}, true};
  volume.texels.reserve(3 * stored.nodes());
  for (int z = 0; z <= last.z; ++z)
    for (int y = 0; y <= last.y; ++y)
      for (int x = 0; x <= last.x; ++x)
        for (int axis = 0; axis < 3; ++axis) volume.texels.push_back(slope({x, y, z}, axis));
  return volume;
}

// What a prototype takes of the device's memory at most.
constexpr std::size_t most_bytes = 500'000;

// Spaces between the surface's nodes in one between the light's: where light is walked, which shows the surface the
// most, where it is not, and beside the most terms.
constexpr double finer_where_walked = transport::surface_finer;
constexpr double finer = 2.0;
constexpr double least_finer = 1.4;

std::size_t bytes(const Volume& volume) { return volume.texels.size() * (volume.bytes ? 1 : sizeof(std::uint16_t)); }

glm::ivec3 surface_nodes(const StoredTransport& stored, double times) {
  return glm::ivec3(times * glm::dvec3(stored.size - 1)) + 1;
}

std::size_t product(const glm::ivec3& size) {
  return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
}

// Beside all that `inputs` hold already.
bool has_room_for_surface(const MaterialInputs& inputs, const glm::ivec3& nodes) {
  std::size_t sum = product(nodes) * sizeof(std::uint16_t);
  for (const auto& [name, volume] : inputs.volumes) sum += bytes(volume);
  for (const auto& [name, table] : inputs.tables) sum += table.texels.size() * sizeof(glm::vec4);
  return sum <= most_bytes;
}

// Of values at nodes of a box, x fastest, those at every second.
std::vector<float> at_every_second_node(const std::vector<float>& values, const glm::ivec3& size) {
  std::vector<float> result;
  for (int z = 0; z < size.z; z += 2)
    for (int y = 0; y < size.y; y += 2)
      for (int x = 0; x < size.x; x += 2) {
        const int index = (z * size.y + y) * size.x + x;
        result.push_back(values[static_cast<std::size_t>(index)]);
      }
  return result;
}

// Taken at fewer nodes, rather than fitted to all, distances from a bevel that is narrower than a cell lift the whole
// cell out of the grain, a cube of radius 10 was 0.8 % too dark, and walks meet facets' directions less well. A cube's
// sharp edges lie best where the nodes of twice the light's fineness have them.
// They are `finest` times as near as light's, or as near as there is room for.
void add_surface(const StoredTransport& stored, double finest, MaterialInputs& inputs) {
  double times = finest;
  while (times > least_finer && !has_room_for_surface(inputs, surface_nodes(stored, times)))
    times = std::max(0.95 * times, least_finer);
  glm::ivec3 known = transport::surface_size(stored.size);
  std::vector<float> distances = stored.distances;
  if (times <= finer) {
    distances = at_every_second_node(distances, known);
    known = (known + 1) / 2;
  }
  const glm::ivec3 size = surface_nodes(stored, times);
  if (size != known) distances = at_fewer_nodes(distances, known, size);
  inputs.uniforms["stored.surface_nodes_a_unit"] = glm::vec3(size - 1) / (stored.spacing * glm::vec3(stored.size - 1));
  inputs.uniforms["stored.last_surface_node"] = glm::vec3(size - 1);
  inputs.volumes["distances"] = {size.x, size.y, size.z, 1, std::move(distances)};
}

using FourMaps = std::array<std::vector<float>, terms_a_texel>;

// Of a channel's lobes.
FourMaps lobe_maps(const StoredTransport& stored, const Blocks& blocks, int block, std::size_t channel) {
  FourMaps maps;
  for (std::size_t component = 0; component < terms_a_texel; ++component) {
    std::vector<float> lobe(transport::octahedron_texels);
    for (std::size_t texel = 0; texel < lobe.size(); ++texel)
      lobe[texel] = stored.lobes[stored.lobe(blocks.term(block, component), texel, channel)];
    maps[component] = framed_map(lobe, counts_of(stored).lobe_side);
  }
  return maps;
}

// Below those that are there, each times a factor.
void put_below(const FourMaps& maps, const FourNumbers& factor, int side, Volume& volume) {
  volume.width = framed(side);
  volume.height += framed(side);
  volume.depth = 1;
  for (std::size_t texel = 0; texel < maps.front().size(); ++texel)
    for (std::size_t component = 0; component < terms_a_texel; ++component)
      volume.texels.push_back(factor[component] * maps[component][texel]);
}

// Of what is seen the leading terms are nearly all: their maps are in half precision. Of the others a byte tells
// enough, over what they are multiplied by.
void add_lobes(const StoredTransport& stored, const Blocks& blocks, MaterialInputs& inputs) {
  const int side = counts_of(stored).lobe_side;
  Volume& leading = inputs.volumes["lobes"];
  Volume& lesser = inputs.volumes["lesser_lobes"];
  lesser.bytes = true;
  Table factors{0, 1, {}};
  for (std::size_t channel = 0; channel < static_cast<std::size_t>(stored.channels); ++channel)
    for (int block = 0; block < blocks.count; ++block) {
      const FourMaps maps = lobe_maps(stored, blocks, block, channel);
      FourNumbers factor = scales(stored, blocks, block);
      if (blocks.leads(block)) {
        put_below(maps, factor, side, leading);
        continue;
      }
      FourNumbers over{};
      for (std::size_t component = 0; component < terms_a_texel; ++component) {
        float largest = 0.0F;
        for (const float value : maps[component]) largest = std::max(largest, std::abs(value));
        if (largest == 0.0F) largest = 1.0F;
        factor[component] *= largest;
        over[component] = 1.0F / largest;
      }
      factors.texels.emplace_back(factor[0], factor[1], factor[2], factor[3]);
      put_below(maps, over, side, lesser);
    }
  factors.width = static_cast<int>(factors.texels.size());
  inputs.tables["lesser_scales"] = std::move(factors);
}

}  // namespace

TurnAndStretch turn_and_stretch(const glm::dmat3& linear) {
  glm::dmat3 turn = linear;
  constexpr int most_steps = 64;
  for (int step = 0; step < most_steps; ++step) {
    const glm::dmat3 other = glm::transpose(glm::inverse(turn));
    double size = 0.0, other_size = 0.0, change = 0.0;
    for (int i = 0; i < 3; ++i) {
      size += glm::dot(turn[i], turn[i]);
      other_size += glm::dot(other[i], other[i]);
    }
    // Scaled so that large and small transforms take as few steps as a turn does.
    const double scale = std::pow(other_size / size, 0.25);
    const glm::dmat3 next = 0.5 * (scale * turn + other / scale);
    for (int i = 0; i < 3; ++i) change += glm::dot(next[i] - turn[i], next[i] - turn[i]);
    turn = next;
    if (change < 1e-28) break;
  }
  return {turn, glm::transpose(turn) * linear};
}

// All that does not depend on the mesh.
MaterialInputs transport_inputs(const scene::Material& material, double /*grain_radius*/) {
  if (material.boundary == scene::Boundary::lambert_lambert || material.boundary == scene::Boundary::lambert_refracted)
    throw Error("boundary for the model transport must be dielectric or index_matched; got '{}'.",
                scene::name_of(material.boundary));
  const transport::StoredMedium medium = stored_medium(material);
  MaterialInputs inputs;
  if (medium.eta != 1.0) inputs.defines.emplace_back("REFRACTION");
  if (medium.grey()) inputs.defines.emplace_back("GREY");
  inputs.uniforms["stored.eta"] = static_cast<float>(medium.eta);
  if (is_walked(material)) inputs.defines.emplace_back("WALKED");
  if (has_facets(material)) {
    add_reflection(material, inputs);
    inputs.defines.emplace_back("FACETS");
  } else {
    add_dielectric(material, inputs);
  }
  return inputs;
}

transport::Order transport_order(const scene::Material& material, scene::MeshPointer mesh, const glm::dmat3& stretch) {
  return {std::move(mesh), stretch, stored_medium(material)};
}

bool stores_lights(const scene::Material& material) { return !is_walked(material); }

MaterialInputs prototype_inputs(const scene::Material& material, const StoredTransport& stored) {
  MaterialInputs inputs = material_inputs(material);
  const glm::dvec3 sigma_t =
      glm::min(stored.unit * stored_medium(material).sigma_t, glm::dvec3(transport::densest_told(stored.spacing)));
  const glm::dvec3 unscattered =
      is_walked(material) ? stored.unit * material.scale * (material.sigma_a + material.sigma_s) : sigma_t;
  if (stored.mean_chord * std::min({unscattered.r, unscattered.g, unscattered.b}) < most_clear)
    inputs.defines.emplace_back("CLEAR");
  // Where light is walked what is stored but ends walks, and shows little of its least terms; how the surface lies
  // shows the more: it takes their room.
  const Counts& counts = counts_of(stored);
  const int terms = is_walked(material) ? std::min(stored.terms, counts.more) : stored.terms;
  if (terms > counts.fewest)
    inputs.defines.emplace_back(terms > counts.more ? "MOST_TERMS" : terms > counts.many ? "MORE_TERMS" : "MANY_TERMS");
  inputs.uniforms["stored.x_axis"] = stored.axes[0];
  inputs.uniforms["stored.y_axis"] = stored.axes[1];
  inputs.uniforms["stored.z_axis"] = stored.axes[2];
  inputs.uniforms["stored.lower"] = stored.lower;
  inputs.uniforms["stored.nodes_a_unit"] = 1.0F / stored.spacing;
  inputs.uniforms["stored.last_node"] = glm::vec3(stored.size - 1);
  inputs.uniforms["stored.units"] = static_cast<float>(1.0 / stored.unit);
  inputs.uniforms["stored.sigma_t"] = glm::vec3(sigma_t);
  inputs.uniforms["stored.albedo"] = glm::vec3(stored_medium(material).albedo);
  if (stored.convex) inputs.defines.emplace_back("CONVEX");
  if (!stored.convex && stored.mean_chord < hollow) inputs.defines.emplace_back("HOLLOW");
  if (is_walked(material)) {
    add_forward(material, stored, inputs);
    if (stored.has_unscattered) inputs.volumes["smooth_slopes"] = smooth_slopes_volume(stored);
  }
  // Of the sphere that has this mean chord.
  add_light_about(material, 0.75 * stored.unit * stored.mean_chord, inputs);
  const Blocks blocks(stored, terms);
  add_lobes(stored, blocks, inputs);
  inputs.volumes["sources"] = sources_volume(stored, blocks);
  const bool shows_surface = is_walked(material) && terms == counts.many;
  add_surface(stored, terms > counts.more ? least_finer : shows_surface ? finer_where_walked : finer, inputs);
  return inputs;
}

StandIn stand_in(const scene::Material& material, double grain_radius) {
  scene::Material other = material;
  other.model = scene::Model::model_3;
  return {other.model, material_inputs(other, grain_radius)};
}

}  // namespace mesograin::models
