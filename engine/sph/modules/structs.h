/* The structs and tables of inputs, material values and results that modules declare (declarations.h). */
#ifndef CLAST_ENGINE_SPH_MODULES_STRUCTS_H
#define CLAST_ENGINE_SPH_MODULES_STRUCTS_H

#include "schemas/rows.h"

/* A nest of scene/inputs.c, material/materials.c or observe/results.c gives it its place. */
#define SPH_MODULE_TABLE(name_, rows_) FIELD_TABLE(rows_, struct name_, #name_, NULL)

#define SPH_MODULE_STRUCTS
#define MODULE_INPUTS(name)   extern const struct field_table sph_##name##_inputs;
#define MODULE_MATERIAL(name) extern const struct field_table sph_##name##_material;
#define MODULE_RESULTS(name)  extern const struct field_table sph_##name##_results;
#include "engine/sph/modules/declarations.h"

#endif
