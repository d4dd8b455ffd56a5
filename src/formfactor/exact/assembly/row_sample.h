// A sample of the rows, to foresee the cost of all of them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/processor_clock.h"
#include "formfactor/exact/assembly/exact_scene.h"
#include "formfactor/exact/assembly/recorded_pairs.h"
#include "formfactor/exact/occluded/occluded_cost.h"

namespace radiosity {

/// Pairs with this many occluders or more are a class of their own: they are few, each takes up to
/// a thousand times as long as others, and most of that is not foreseen. (Six spheres' facets in a
/// box: one pair in ten has more, and these take nine tenths of the time.)
inline constexpr Index kManyOccluders = 32;
enum Clutter : std::size_t { few_occluders, many_occluders, clutter_classes };

/// Occluded pairs of one class.
struct SampledPairs {
  std::vector<OccludedPair> pairs;  ///< in order of their columns
  OccludedCost cost;                ///< of all that these stand for in the rows looked at
};

/// Some rows and facets after theirs: counts, scaled up to all pairs of these rows with these
/// facets.
struct SampledPlace {
  double weight = 0;   ///< open pairs that it stands for
  double settled = 0;  ///< pairs of the rows with the facets
  double closely = 1;  ///< pairs for each that was settled in the descent
  double unoccluded = 0;
  double occluded = 0;
  double occluders = 0;
  double shaft_tests = 0;
  double rows = 0;
  double record_bytes = 0;
  double seconds_visibility = 0;
  BothClocks taken;  ///< by all of it
  std::array<SampledPairs, clutter_classes> classes;
  std::vector<PairBlock> blocks;     ///< unoccluded
  std::vector<Index> occluder_list;  ///< of the occluded pairs

  /// Open pairs for each settled one; 0 if none was settled.
  double share() const { return settled > 0 ? weight / settled : 0.0; }
};

/// Counts scaled up to all rows, and the places that they come from.
struct RowSample {
  double unoccluded = 0;  ///< pairs with nothing in between, or below the horizon
  double occluded = 0;    ///< pairs that go to the clipping
  double occluders = 0;   ///< candidates, summed over these
  double shaft_tests = 0;
  OccludedCost cost;           ///< of the occluded pairs
  std::size_t task_bytes = 0;  ///< most that the occluded pairs of a task take, about
  std::vector<SampledPlace> places;
  /// Open pairs of all places over those of places where pairs were settled.
  double all_places = 1;
};

/// The most steps of progress, and places, of a sample of all rows.
inline constexpr std::size_t kSampleSteps = 96;

/// Some rows in up to `steps` places, of large facets and of small ones, against later facets
/// of many elements or of few: all of these, or every n-th if there are very many. The work has a
/// bound, in tests and pairs and not by the clock, so that the counts come out the same in every
/// run. Of the rows of the first tasks; `cost` is left to foreseeCost(). Goes on with the places
/// that an equal call looked at before it was cancelled. Steps `progress`; calls its check().
void samplePairs(const ExactScene& scene, std::size_t tasks, std::size_t steps, RowSample& sample,
                 Progress& progress);
/// Foresees what the sampled pairs cost to this tolerance.
void foreseeCost(const ExactScene& scene, double tolerance, RowSample& sample);
/// Both, of all rows.
void sampleRows(const ExactScene& scene, double tolerance, RowSample& sample, Progress& progress);

}  // namespace radiosity
