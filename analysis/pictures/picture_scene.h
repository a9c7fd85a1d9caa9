/* The contents of a picture of particles: discs, their order, frame and colours. For picture_particles.c only. */
#ifndef CLAST_ANALYSIS_PICTURES_PICTURE_SCENE_H
#define CLAST_ANALYSIS_PICTURES_PICTURE_SCENE_H

#include "analysis/pictures/picture.h"
#include "analysis/pictures/picture_canvas.h"
#include "analysis/pictures/picture_layout.h"

enum { PICTURE_SCENE_RESOLVED = 10 }; /* particles: a smaller fragment is poorly resolved and gets a pale tint */

struct picture_scene {
  const struct picture_cloud *cloud;
  const struct picture_look *look;
  size_t fragments, discs;
  uint32_t *count; /* particles by fragment */
  double *mass;    /* kg by fragment */
  double (*centre)[3];
  double middle[3]; /* m: centre of the heaviest fragment, or of all particles */
  struct picture_layout_disc *disc;
  double low, high, scale; /* range of the colours; values are divided by `scale` */
  double view[4];
  size_t left_out; /* number of particles outside the frame */
  int axis;        /* axis of the line of sight */
  double hidden;   /* mass share of large fragments that are hidden */
  char label[160];
  enum picture_ramp ramp;
};

/* Computes mass, centre and number of particles of each fragment, and the middle of the picture. STATUS_MEMORY. */
status picture_scene_gather(struct picture_scene *scene);
void picture_scene_clear(struct picture_scene *scene);

/* Chooses the discs along the line of sight, nearest last. */
void picture_scene_choose_discs(struct picture_scene *scene);
/* Turns the body so that the heaviest fragments are as visible as possible, unless the direction is given. */
status picture_scene_turn(struct picture_scene *scene);
/* Chooses the frame and leaves out discs that do not fit into it: jets and small fragments far away. */
status picture_scene_frame(struct picture_scene *scene);
/* Chooses range, ramp and label of the values, if there are any. */
status picture_scene_choose_colours(struct picture_scene *scene);

/* Computes the mass of the particles that were searched for fragments, and of the single ones, kg. Returns the number
 * of the searched ones. */
size_t picture_scene_masses(const struct picture_cloud *cloud, double *total, double *single);

#endif
