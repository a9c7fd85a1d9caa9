/* The subject of a study of convergence: a scene, or every point of a campaign. */
#ifndef CLAST_CAMPAIGN_CONVERGE_SUBJECT_H
#define CLAST_CAMPAIGN_CONVERGE_SUBJECT_H

#include "campaign/converge/study.h"
#include "campaign/terminal/option.h"

enum { SUBJECT_SCENES = 64 };

/* The study, and the objects that it borrows from. */
struct subject {
  struct study study;
  struct campaign *campaign;            /* NULL: a scene was named */
  struct scene *scenes[SUBJECT_SCENES]; /* owned */
  size_t scene_count;
  char reference[2 * FIELD_TEXT_SIZE]; /* path of the scene from the current folder */
};

/* A file of a campaign or a scene, or a built-in scene; `set` as in scene_option_apply(). Fills the study's limits.
 * Clear it also after an error. STATUS_CONTENT: too many points; what the loaders return. */
status subject_load(struct subject *subject, const char *path, const struct option_list *set, struct error *error);
void subject_clear(struct subject *subject);

#endif
