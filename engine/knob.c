/* The words of the groups of knobs. */
#include "engine/knob.h"

#include "schemas/field.h"

FIELD_WORDS(knob_group_names, KNOB_GROUPS, [KNOB_RESOLUTION] = "resolution", [KNOB_PART] = "part",
            [KNOB_MODEL] = "model", [KNOB_SETTINGS] = "settings");
