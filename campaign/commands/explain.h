/* What the commands that take a scene share: --set, and the list of its inputs. */
#ifndef CLAST_CAMPAIGN_COMMANDS_EXPLAIN_H
#define CLAST_CAMPAIGN_COMMANDS_EXPLAIN_H

#include "campaign/terminal/option.h"
#include "campaign/terminal/table.h"
#include "engine/scene.h"

struct explain_options {
  struct option_list set;
  struct table_options table;
};

#define EXPLAIN_SET(type_, member_)                                                                                    \
  OPTION_ROW_LIST(                                                                                                     \
      "set", 's', "PATH=VALUE", type_, member_,                                                                        \
      "Override an input of the scene: threshold.strain=3%, impact.speed='50 m/s'. May be given several times. "       \
      "Inputs of the scene that have no effect any more are dropped.")

/* Loads the scene `name` (built-in or a file), sets each PATH=VALUE of `set`, and checks it. *scene is the caller's to
 * free, also on errors. STATUS_USAGE, STATUS_CONTENT, what scene_load returns. */
status explain_load(const char *name, const struct option_list *set, struct scene **scene, struct error *error);
/* The first sentence of a meaning, without its full stop. */
void explain_sentence(const char *doc, char *text, size_t size);

#endif
