/* Variables that release themselves where their block is left, as OWNED, SCENE, STORE and CAMPAIGN of the program do.
 */
#pragma once

#include "schemas/memory.h"

/* A struct that `release` empties: OWNED_BY(csv_close) struct csv table; */
#define OWNED_BY(release) __attribute__((cleanup(release)))

/* release_at(): the same of a pointer, for OWNED_BY. */
#define OWNED_AT(release, type)                                                                                        \
  void release(type *);                                                                                                \
  __attribute__((unused)) static void release##_at(type **at) {                                                        \
    release(*at);                                                                                                      \
  }
struct dem_system;
struct dem_tessellation;
struct mesh;
struct sph_flaws;
struct sph_particles;
struct sph_system;
OWNED_AT(dem_run_free, void)
OWNED_AT(dem_system_free, struct dem_system)
OWNED_AT(dem_tessellation_free, struct dem_tessellation)
OWNED_AT(mesh_free, struct mesh)
OWNED_AT(sph_flaws_free, struct sph_flaws)
OWNED_AT(sph_particles_free, struct sph_particles)
OWNED_AT(sph_run_free, void)
OWNED_AT(sph_system_free, struct sph_system)
#define DEM_RUN          OWNED_BY(dem_run_free_at) void
#define DEM_SYSTEM       OWNED_BY(dem_system_free_at) struct dem_system
#define DEM_TESSELLATION OWNED_BY(dem_tessellation_free_at) struct dem_tessellation
#define MESH             OWNED_BY(mesh_free_at) struct mesh
#define SPH_FLAWS        OWNED_BY(sph_flaws_free_at) struct sph_flaws
#define SPH_PARTICLES    OWNED_BY(sph_particles_free_at) struct sph_particles
#define SPH_RUN          OWNED_BY(sph_run_free_at) void
#define SPH_SYSTEM       OWNED_BY(sph_system_free_at) struct sph_system
