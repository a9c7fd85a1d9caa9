/* The sources of a scene's active models and values: from field tables and named materials. */
#ifndef CLAST_CAMPAIGN_TERMINAL_SCENE_SOURCES_H
#define CLAST_CAMPAIGN_TERMINAL_SCENE_SOURCES_H

#include "engine/scene.h"

/* Called for each source. `what`: its subject, which is the engine, a path, or "target.material.density of basalt". */
typedef void (*scene_sources_each)(void *context, const char *what, const char *source);
void scene_sources(const struct scene *scene, scene_sources_each each, void *context);

#endif
