/* Engine `sph`: solids that crack, in 3D (Benz & Asphaug 1994, 1995). */
#pragma once

#include "engine/engine.h"
#include "engine/sph/observe/results.h"
#include "engine/sph/scene/inputs.h"

extern const struct engine_kind sph_engine;
