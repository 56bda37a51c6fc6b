#pragma once
// Names of the arrays in the field data of a result: what write_result() writes and read_result() reads.

namespace clerestory::arrays {

/// Counts what a reader must know: raised when a file of before can no longer be read, or one of now not by a reader of
/// before.
inline constexpr int kFormatNumber = 1;
inline constexpr const char* kFormat = "result_format";
inline constexpr const char* kReport = "report";
inline constexpr const char* kSceneFiles = "scene_files";
inline constexpr const char* kMaterialNames = "material_names";
inline constexpr const char* kMaterialKinds = "material_kinds";
inline constexpr const char* kMaterialReflectance = "material_reflectance";
inline constexpr const char* kMaterialTransmittance = "material_transmittance";
inline constexpr const char* kMaterialGloss = "material_gloss";  ///< specular, exponent or -1, roughness
inline constexpr const char* kSurfaceNames = "surface_names";
inline constexpr const char* kRoomNames = "room_names";
inline constexpr const char* kPaneCorners = "pane_corners";
inline constexpr const char* kPaneMaterial = "pane_material";
inline constexpr const char* kPaneSurface = "pane_surface";
inline constexpr const char* kSky = "sky_radiance";
inline constexpr const char* kDaylightReference = "daylight_reference";
inline constexpr const char* kSensorSets = "sensor_set_names";
inline constexpr const char* kSensorKinds = "sensor_set_kinds";
inline constexpr const char* kSensorThresholds = "sensor_set_thresholds";
inline constexpr const char* kSensorSet = "sensor_set";
inline constexpr const char* kSensorPositions = "sensor_positions";
inline constexpr const char* kSensorNormals = "sensor_normals";
inline constexpr const char* kSensorIlluminance = "sensor_illuminance";
inline constexpr const char* kSensorLayers = "sensor_layers";
inline constexpr const char* kLayerNames = "layer_names";
inline constexpr const char* kLayerEnergy = "layer_energy";
inline constexpr const char* kLayerFlux = "layer_luminous_flux";
inline constexpr const char* kLayerFactors = "layer_factors";
inline constexpr const char* kLuminairePositions = "luminaire_positions";
inline constexpr const char* kLuminaireFlux = "luminaire_flux";
inline constexpr const char* kLuminaireNames = "luminaire_names";
inline constexpr const char* kLuminaireGroups = "luminaire_groups";
inline constexpr const char* kYearPart = "year_part";
inline constexpr const char* kYearTables = "year_part_";  ///< what their names begin with

}  // namespace clerestory::arrays
