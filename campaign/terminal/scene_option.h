/* Shared by the commands that take a scene: its inputs from --set. */
#ifndef CLAST_CAMPAIGN_TERMINAL_SCENE_OPTION_H
#define CLAST_CAMPAIGN_TERMINAL_SCENE_OPTION_H

#include "campaign/terminal/option.h"
#include "engine/scene.h"

#define SCENE_OPTION_SET(type_, member_)                                                                               \
  OPTION_ROW_LIST(                                                                                                     \
      "set", 's', "PATH=VALUE", type_, member_,                                                                        \
      "Override an input of the scene: threshold.strain=3%, impact.speed='50 m/s'. May be given several times. "       \
      "clast drops inputs of the scene that no longer have an effect.")

/* Loads the scene `name` (built-in or a file), sets each PATH=VALUE of `set`, and checks it. The caller frees *scene,
 * also on errors. STATUS_USAGE, STATUS_CONTENT, what scene_load returns. */
status scene_option_load(const char *name, const struct option_list *set, struct scene **scene, struct error *error);

/* Sets and checks the inputs of a loaded scene. */
status scene_option_apply(struct scene *scene, const struct option_list *set, struct error *error);

#endif
