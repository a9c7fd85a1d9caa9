/* Where what a scene switches on comes from: the sources of field tables and of named materials. */
#ifndef CLAST_CAMPAIGN_TERMINAL_SCENE_SOURCES_H
#define CLAST_CAMPAIGN_TERMINAL_SCENE_SOURCES_H

#include "engine/scene.h"

/* Gives each source away, and says of what it is: the engine, a path, "target.material.density of basalt". */
typedef void (*scene_sources_each)(void *context, const char *what, const char *source);
void scene_sources(const struct scene *scene, scene_sources_each each, void *context);

#endif
