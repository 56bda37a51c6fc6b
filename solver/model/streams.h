#pragma once
// What random numbers are drawn for: the one list of streams. Each has a number of its own (tests/layers_test.cpp), so
// that no two estimates share their noise; a key is made of seed, stream and what is estimated, by stream_key().

#include <cstdint>

namespace clerestory {

enum Stream : std::uint64_t {
  // Final gather: the same for all points.
  kGatherBundle = 0x01,
  kGatherPilots = 0x02,
  kGatherBrightChoices = 0x03,
  kGatherSunPoints = 0x04,
  kGatherAreas = 0x05,
  kGatherBrightPilots = 0x07,
  kAreaPoints = 0xc1,
  kAreaPilots = 0xc2,
  // Direct light, by patch or luminaire.
  kShadowPointsOfPatch = 0x11,
  kSkyRaysOfPatch = 0x12,
  kFluxOfLuminaire = 0x13,
  kOpeningRaysOfPatch = 0x14,
  kPointsOfLuminaire = 0x15,
  kGlossOfPatch = 0x18,
  // Ways of luminaires and suns over mirrors and panes; the stream takes the seed's place.
  kWaysOfLuminaire = 0x16,
  kWaysOfSun = 0x17,
  // Spaces, by patch, luminaire or opening.
  kClosureRays = 0x21,
  kSideRays = 0x31,
  kLuminaireRays = 0x32,
  kLuminaireSearch = 0x33,
  kOpeningRays = 0x34,
  // Methods, by patch or pair of them.
  kShots = 0x41,
  kPathsOfPatch = 0x51,
  kNoisyPatches = 0x84,
  kMatrixPairs = 0xd1,
  kEchoFactors = 0xd2,
  kParticles = 0x52,
  kCaustics = 0x5a,
  kErrorCaustics = 0x5b,
  kErrorPilots = 0x5c,
  // Points, by number.
  kPathsOfSensor = 0x61,
  kPathsOfSample = 0x62,
  kBuriedPoints = 0x63,
  kPanelRays = 0x64,
  // Measured error, by point.
  kErrorPoints = 0x71,
  kErrorPaths = 0x72,
  kSensorErrorPaths = 0x73,
  kErrorGathers = 0x74,
  // Reference of a sweep over methods, by point and round.
  kReferencePoints = 0x75,
  kReferencePaths = 0x76,
  // Laws: in the seed's place, and by room.
  kLawClosure = 0x77,
  kLawDirect = 0x78,
  kLawRays = 0x79,
  // Search for openings, by gap: judging them, sifting them, and once more. The stream takes the seed's place: a model
  // has the same openings for every seed.
  kGapRays = 0x81,
  kGapsSifted = 0x82,
  kGapsSiftedAgain = 0x83,
  kReach = 0x8a,
  // Rooms, by patch and sweep; in the seed's place as well.
  kRoomRays = 0x85,
  kRoomOrder = 0x86,
  kRoomSides = 0x87,
  // Hierarchy, by receiver, element or link.
  kBundle = 0x91,
  kBrightPairs = 0x92,
  kBrightPairPilot = 0x93,
  kSlitLines = 0x94,
  kSlitGains = 0x95,
  kVariationProbe = 0xa1,
  kBfPairs = 0xb1,
  // Points of the sun's disc, by hour of a year; what its error is measured with, by hour.
  kSunOfHour = 0xe1,
  kYearErrorPoints = 0xe2,
  kYearErrorPaths = 0xe3,
  // Panes that turn a ray back, by ray; and whether one of these is followed further.
  kPanesOfRay = 0x88,
  kEchoes = 0x89,
  kGlossOfRay = 0x8d,
  kGlossPairs = 0x8e,
  kGlossSeen = 0x8f,
  // Lights and surfaces that a point looks at which is seen in a picture, by pixel; lights of a result's points.
  kLightsSeen = 0x54,
  kGatherSeen = 0x55,
  kLightsOfPoints = 0x56,
  // Pairs of surfaces whose visibility is sampled: one pattern for all.
  kVisibilityPattern = 0x7061747465726e,
  // Segments to openings and bright areas that may be in view: one pattern for all.
  kAreasInView = 0x61726561,
};

}  // namespace clerestory
