/* The structs of inputs, material values and results that modules declare (declarations.h). */
#pragma once

#include "schemas/rows.h"

#define SPH_MODULE_STRUCTS
#include "engine/sph/modules/declarations.h"
