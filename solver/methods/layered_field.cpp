#include "solver/methods/layered_field.h"

#include <algorithm>
#include <utility>

namespace clerestory {
namespace {

void add(std::span<const double> lanes, double weight, std::span<double> to) {
  for (std::size_t l = 0; l < to.size(); ++l) to[l] += weight * lanes[l];
}

bool any_channel_dark(std::span<const double> lanes, int channels) {
  for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) {
    double sum = 0;
    for (std::size_t l = c; l < lanes.size(); l += static_cast<std::size_t>(channels)) sum += lanes[l];
    if (!(sum > 0)) return true;
  }
  return false;
}

/// What puts delta light of the leaves of what was one element right: a factor, its exact flux over their corners'
/// mean; or, where no corner sees any (a luminaire near by may shine between them), all of it, evenly.
struct DeltaGains {
  std::vector<double> factor, evenly;
};
DeltaGains delta_gains(const ElementMesh& mesh, std::span<const std::uint32_t> leaves, const VertexField& field,
                       std::span<const double> exact) {
  std::vector<double> mean(exact.size());
  double area = 0;
  for (const std::uint32_t leaf : leaves) {
    const double part = mesh[leaf].area;
    for (const std::uint32_t p : mesh.points_of(leaf)) add(lanes_of(field.delta_layers, p), part / 3, mean);
    area += part;
  }
  DeltaGains gain{std::vector<double>(exact.size(), 1.0), std::vector<double>(exact.size(), 0.0)};
  for (std::size_t l = 0; l < exact.size(); ++l)
    if (mean[l] > 0)
      gain.factor[l] = exact[l] * area / mean[l];
    else
      gain.evenly[l] = exact[l];
  return gain;
}

}  // namespace

void finish_layers(const ElementMesh& mesh, const TransportLayers& transport, int channels, VertexField& field) {
  std::vector<bool> filled = field.known;
  for (std::size_t j = 0; j < transport.leaves.size(); ++j) {
    const std::uint32_t leaf = transport.leaves[j];
    for (const std::uint32_t p : mesh.points_of(leaf))
      if (!field.known[p]) {
        add(lanes_of(transport.E, j), mesh[leaf].area, lanes_of(field.layers, p));
        filled[p] = true;
      }
  }
  std::vector<double> rest(static_cast<std::size_t>(field.layers.channels));
  for (std::size_t p = 0; p < field.E.size(); ++p) {
    const std::span<double> all = lanes_of(field.layers, p), delta = lanes_of(field.delta_layers, p);
    if (!filled[p])
      for (const std::uint32_t end : mesh.ends(p)) add(lanes_of(std::as_const(field.layers), end), 1, all);
    for (std::size_t l = 0; l < rest.size(); ++l) rest[l] = all[l] - delta[l];
    divide_among_layers(field.known[p] ? field.E[p] - field.delta_light[p] : field.E[p], channels, rest);
    for (std::size_t l = 0; l < rest.size(); ++l) all[l] = rest[l] + delta[l];
  }
}

Field irradiance_of_layers(const ElementMesh& mesh, const TransportLayers& transport, const VertexField& field,
                           const Field& E) {
  const std::vector<std::uint32_t> leaves = mesh.leaves();
  Field E_layers(leaves.size(), field.layers.channels);
  std::size_t i = 0;
  for (std::size_t j = 0; j < transport.leaves.size(); ++j) {
    const auto parts = std::span(leaves).subspan(i, mesh.leaves_under(transport.leaves[j]));
    const DeltaGains gain = delta_gains(mesh, parts, field, lanes_of(transport.delta_light, j));
    for (const std::uint32_t leaf : parts) {
      const std::span<double> own = lanes_of(E_layers, i);
      for (const std::uint32_t p : mesh.points_of(leaf)) {
        add(lanes_of(field.layers, p), 1, own);
        const std::span<const double> delta = lanes_of(field.delta_layers, p);
        for (std::size_t l = 0; l < own.size(); ++l) own[l] += (gain.factor[l] - 1) * delta[l] + gain.evenly[l];
      }
      if (any_channel_dark(own, E.channels)) std::ranges::copy(lanes_of(transport.E, j), own.begin());
      divide_among_layers(E[i], E.channels, own);
      ++i;
    }
  }
  return E_layers;
}

Field radiosity_of_layers(const PatchSet& elements, const Field& E, std::span<const Layer> layers) {
  Field B = exitance(elements, layers);
  for (std::size_t s = 0; s < layers.size(); ++s) {
    const Field E_of_layer = one_layer(E, s, elements.channels);
    for (std::size_t i = 0; i < B.size(); ++i) {
      const Spectrum scattered = elements.scattered(E_of_layer, i);
      for (int c = 0; c < elements.channels; ++c) B.at(i, static_cast<int>(s) * elements.channels + c) += scattered[c];
    }
  }
  return B;
}

}  // namespace clerestory
