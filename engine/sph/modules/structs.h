/* The structs of inputs, material values and results that modules declare (declarations.h). */
#ifndef CLAST_ENGINE_SPH_MODULES_STRUCTS_H
#define CLAST_ENGINE_SPH_MODULES_STRUCTS_H

#include "schemas/rows.h"

#define SPH_MODULE_STRUCTS
#include "engine/sph/modules/declarations.h"

#endif
