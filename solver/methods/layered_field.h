#pragma once
// The field of each layer, from that of all of them together.

#include <span>
#include <vector>

#include "solver/hierarchy/vertex_field.h"
#include "solver/methods/kept_transport.h"

namespace clerestory {

/// Layers side by side, lane s * channels + c; their sums are the E and B of the whole light.
struct LayeredField {
  Field E;                            ///< P x lanes, by point of the lightmap [W/m2]; empty: not asked for, or stopped
  Field E_elements;                   ///< N x lanes, of the elements [W/m2]
  Field B;                            ///< N x lanes, of the elements, for sensors to gather from [W/m2]
  std::vector<EnergyBalance> energy;  ///< of each layer, as the links balanced it

  bool empty() const { return E.value.empty(); }
};

/// Layers on the elements as they were for transport.
struct TransportLayers {
  std::vector<std::uint32_t> leaves;  ///< of the mesh
  Field E;                            ///< by leaf, N x lanes [W/m2]
  Field delta_light;                  ///< part of E, of luminaires and suns
};

/// Layers at all points: what was gathered, all but delta light scaled to E of the field as it is shown in the end;
/// where nothing was gathered, what the elements around receive.
void finish_layers(const ElementMesh& mesh, const TransportLayers& transport, int channels, VertexField& field);

/// Irradiance of the leaves in each layer, N x lanes: layers share what a leaf receives as they do at its corners,
/// their delta light scaled to its exact flux; or in what it was a part of for transport, where corners are dark.
///
/// E  of the leaves of the mesh: all that they receive.
Field irradiance_of_layers(const ElementMesh& mesh, const TransportLayers& transport, const VertexField& field,
                           const Field& E);

/// What leaves the elements in each layer, N x lanes, where they receive E (N x lanes): M + rho E.
Field radiosity_of_layers(const PatchSet& elements, const Field& E, std::span<const Layer> layers);

}  // namespace clerestory
