/* Instantiates the range loops for one CPU class: the including file sets RANGES_TABLE. */
#include "engine/sph/modules/ranges.h"

#include "engine/sph/modules/crack_range.h"
#include "engine/sph/modules/elastic_range.h"
#include "engine/sph/modules/motion_range.h"
#include "engine/sph/modules/palpha_range.h"
#include "engine/sph/modules/tillotson_range.h"
#include "engine/sph/modules/yield_range.h"

const struct sph_ranges RANGES_TABLE = {
    .motion_predict = motion_predict,
    .elastic_predict = elastic_predict,
    .damage_predict = crack_damage_predict,
    .tillotson = tillotson_range,
    .palpha = palpha_range,
    .palpha_limit = palpha_limit,
    .tension_limit = tillotson_tension_limit,
    .yield = yield_range,
    .crack = crack_range,
    .output_fluid = motion_output_fluid,
    .output_whole = elastic_output_whole,
    .output_damaged = elastic_output_damaged,
    .hold = motion_hold,
    .fluid_rates = motion_fluid_rates,
    .elastic_rates = elastic_rates,
    .correct_fluid = motion_correct_fluid,
    .correct_whole = motion_correct_whole,
    .correct_damaged = motion_correct_damaged,
};
