/* Velocity gradients exact for linear fields: a term of the pair loop (pairs/pairs.h has the equations).
 *
 *   method.gradient_correction */
#include "engine/sph/modules/ranges.h"

#define INPUTS sph_gradient_correction_inputs

static const struct field input_rows[] = {
    INPUT_SWITCH(method.gradient_correction, on, 0,
                 .doc =
                     "Velocity gradients exact for linear fields, and forces conjugate to them: a body turns without "
                     "strain and keeps its angular momentum, and its free sides are as stiff as its inside. For "
                     "ringing and spinning bodies; costs a quarter more time.",
                 .source = "Randles & Libersky 1996; Bonet & Lok 1999; off in BA95"),
};
const struct field_table sph_gradient_correction_inputs = SPH_MODULE_TABLE(sph_gradient_correction_inputs, input_rows);

static bool on(const struct sph_body_physics *body, const struct sph_inputs *inputs) {
  (void)body, (void)inputs;
  return inputs->gradient_correction.on;
}

/* B = 1 at first: xx xy xz yy yz zz. */
static const struct sph_column_need columns[] = {{SPH_COLUMN(correction[0]), 1, 1, NULL},
                                                 {SPH_COLUMN(correction[1]), 2, 0, NULL},
                                                 {SPH_COLUMN(correction[3]), 1, 1, NULL},
                                                 {SPH_COLUMN(correction[4]), 1, 0, NULL},
                                                 {SPH_COLUMN(correction[5]), 1, 1, NULL},
                                                 {0}};

const struct sph_module sph_gradient_correction_module = {
    .name = "gradient_correction",
    .doc = "Velocity gradients are exact for linear fields, also at surfaces, and forces are conjugate to them: a "
           "rigid rotation "
           "strains nothing, energy and angular momentum keep, free sides are as stiff as the inside.",
    .source = "Randles & Libersky 1996; Bonet & Lok 1999 (Comput. Methods Appl. Mech. Eng. 180, 97)",
    .when = "gradient_correction: true",
    .on = on,
    .columns = columns,
    .bytes_in_pairs = 92, /* wider records; measured */
    .cost = 65,
};
