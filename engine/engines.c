/* The list of engines: a line per engine. A test program with engines of its own has another list in place of this one.
 */
#include "engine/command/command.h"
#include "engine/dem/dem.h"
#include "engine/sph/sph.h"

const struct engine_kind *const engines_list[] = {
    &dem_engine,
    &sph_engine,
    &command_engine,
    NULL,
};
