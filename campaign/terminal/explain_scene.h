/* Explains the model and the cost of a scene, and its inputs with their values. */
#ifndef CLAST_CAMPAIGN_TERMINAL_EXPLAIN_SCENE_H
#define CLAST_CAMPAIGN_TERMINAL_EXPLAIN_SCENE_H

#include "campaign/terminal/table.h"
#include "engine/scene.h"

/* Prints on stdout; for programs only the inputs. */
status explain_scene(const struct scene *scene, enum table_format format, struct error *error);

#endif
