/* Engine `dem`: grains joined by breakable beams, in 2D (Kun, D'Addetta, Herrmann & Ramm 1999). */
#pragma once

#include "engine/dem/observe/results.h"
#include "engine/dem/scene/inputs.h"
#include "engine/engine.h"

extern const struct engine_kind dem_engine;
