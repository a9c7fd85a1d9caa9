/* Instantiates the range loops for one CPU class: the including file sets RANGES_TABLE. */
#include "engine/sph/modules/ranges.h"

#define SPH_MODULE_LOOPS
#include "engine/sph/modules/declarations.h"

const struct sph_ranges RANGES_TABLE = {
    .module =
        {
#define MODULE_HOOKS(name) [SPH_MODULE_##name] = name##_hooks,
#include "engine/sph/modules/declarations.h"
        },
    .predict = motion_predict,
    .output_fluid = motion_output_fluid,
    .output_whole = motion_output_whole,
    .output_damaged = motion_output_damaged,
    .hold = motion_hold,
    .fluid_rates = motion_fluid_rates,
    .correct_fluid = motion_correct_fluid,
    .correct_whole = motion_correct_whole,
    .correct_damaged = motion_correct_damaged,
};
