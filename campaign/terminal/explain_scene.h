/* What a scene models and costs, and its inputs with their values. */
#ifndef CLAST_CAMPAIGN_TERMINAL_EXPLAIN_SCENE_H
#define CLAST_CAMPAIGN_TERMINAL_EXPLAIN_SCENE_H

#include "campaign/terminal/table.h"
#include "engine/scene.h"

/* On stdout; for programs the inputs only. */
status explain_scene(const struct scene *scene, enum table_format format, struct error *error);

#endif
