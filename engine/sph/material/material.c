/* Finding and reading the named materials. */
#include <math.h>
#include <string.h>

#include "engine/builtin.h"
#include "engine/scene.h"
#include "engine/sph/material/material.h"
#include "schemas/memory.h"

#define MATERIAL sph_material

static const struct field rows[] = {
    MATERIAL_REAL(density, density, "kg/m^3", NAN, 1e-3, 1e6, .flags = FIELD_REQUIRED,
                  .doc = "rho_0: density at rest."),
    MATERIAL_REAL(
        melt_energy, melt_energy, "J/kg", NAN, 1, 1e15, .flags = FIELD_MAY_BE_OFF, .when = "../strength=true",
        .doc = "Energy at which the yield stress has fallen to zero, linearly. off: it does not depend on energy.",
        .source = "Benz & Asphaug 1995, section 2"),
#define SPH_MODULE_MATERIAL_ROWS
#include "engine/sph/modules/declarations.h"
};

const struct field_table
    sph_materials_nested = FIELD_TABLE(rows, struct sph_material, "sph material",
                                       "The values of a solid that the scene's physics may ask for.");
struct field_table sph_materials_table;
FIELD_TABLE_AT_START(sph_materials_table, sph_materials_nested)

size_t sph_materials_row(size_t offset) {
  size_t row = 0;
  while (sph_materials_table.rows[row].offset != offset)
    row++;
  return row;
}

const char *sph_materials_name(size_t index) {
  return builtin_material_list[index].name;
}

const char *sph_materials_text(const char *name) {
  return builtin_text(builtin_material_list, name);
}

static const char *const own_keys[] = {"material", "source", "sources", "like", NULL};

static status read_material(struct document *document, struct sph_material *out, struct error *error) {
  field_defaults(&sph_materials_table, out);
  document_node *root = document_root(document);
  if (scene_material_complete(root, &sph_materials) && document_read(root, &sph_materials_table, own_keys, out) &&
      !(out->tillotson.E_cv > out->tillotson.E_iv))
    document_report(root, "tillotson.E_cv", "must be above tillotson.E_iv");
  return document_verdict(document, error);
}

status sph_materials_parse(const char *name, const char *text, struct sph_material *out, struct error *error) {
  DOCUMENT document = NULL;
  TRY(document_parse(name, text, strlen(text), &document, error));
  return read_material(document, out, error);
}

/* The node at a path, or else at the nearest of its sections: "a.b.c", "a.b", "a". NULL: none. */
static document_node *find_section(document_node *sources, const char *path) {
  char key[FIELD_TEXT_SIZE];
  field_copy_text(key, path);
  for (;;) {
    document_node *found = document_key(sources, key);
    char *dot = strrchr(key, '.');
    if (found || !dot)
      return found;
    *dot = '\0';
  }
}

status sph_materials_source(const char *name, const char *path, char source[FIELD_TEXT_SIZE]) {
  const char *text = sph_materials_text(name);
  DOCUMENT document = NULL;
  source[0] = '\0';
  if (!text || document_parse(name, text, strlen(text), &document, NULL) != STATUS_OK)
    return STATUS_MISSING;
  document_node *root = document_root(document);
  (void)scene_material_complete(root, &sph_materials);
  document_node *sources = document_key(root, "sources");
  document_node *found = sources ? find_section(sources, path) : NULL;
  if (!found)
    found = document_key(root, "source");
  field_copy_text(source, found ? document_scalar(found) : NULL);
  return source[0] ? STATUS_OK : STATUS_MISSING;
}

bool sph_materials_must_give(const char *path) {
  static const char *const must[] = {"yield_stress", "melt_energy", "tension_limit", "weibull.m", "weibull.k", NULL};
  return text_is_one_of(path, must);
}

status sph_materials_load(const char *name, void *out, struct error *error) {
  const char *text = sph_materials_text(name);
  if (text)
    return sph_materials_parse(name, text, out, error);
  struct text_guess guess = text_guess(name);
  for (size_t i = 0; sph_materials_name(i); i++)
    text_guess_offer(&guess, sph_materials_name(i));
  const char *near = guess.nearest;
  return status_fail(error, STATUS_MISSING, "there is no material '%.100s'%s%s%s `clast materials` lists them", name,
                     near ? "; did you mean '" : ";", near ? near : "", near ? "'?" : "");
}

static const char *const not_values[] = {"young_modulus", "youngs_modulus", "poisson_ratio", "poissons_ratio", NULL};
static const char *const overview[][2] = {{"density", "density"},
                                          {"tillotson_A", "tillotson.A"},
                                          {"shear_modulus", "shear_modulus"},
                                          {"weibull_m", "weibull.m"},
                                          {"weibull_k", "weibull.k"},
                                          {NULL, NULL}};
static const char *const beside[][2] = {{"fragments.static_strength", "target.material.name"}, {NULL, NULL}};
const struct engine_materials sph_materials = {.values = &sph_materials_table,
                                               .overview = overview,
                                               .not_values = not_values,
                                               .instead = "of Young's modulus E and Poisson's ratio nu, give "
                                                          "bulk_modulus: E / (3 (1 - 2 nu)) and shear_modulus: E / "
                                                          "(2 (1 + nu))",
                                               .either = {"porosity.distention", "porosity.fraction"},
                                               .beside = beside,
                                               .name = sph_materials_name,
                                               .text = sph_materials_text,
                                               .load = sph_materials_load,
                                               .trial = {"engine: sph\n", "target.material", "target.strength", "false",
                                                         "a body without strength"},
                                               .together = {"weibull.m", "weibull.k"},
                                               .source = sph_materials_source};

/* Elastic constants, wave speeds and crack speeds that follow from a material. */

double sph_material_bulk_modulus(const struct sph_material *m) {
  return m->elastic.bulk_modulus > 0 ? m->elastic.bulk_modulus : m->tillotson.A;
}

double sph_material_young_modulus(const struct sph_material *m) {
  const double K = sph_material_bulk_modulus(m);
  return 9 * K * m->elastic.shear_modulus / (3 * K + m->elastic.shear_modulus);
}

double sph_material_poisson_ratio(const struct sph_material *m) {
  const double K = sph_material_bulk_modulus(m);
  return (3 * K - 2 * m->elastic.shear_modulus) / (2 * (3 * K + m->elastic.shear_modulus));
}

double sph_material_crack_speed(const struct sph_material *m) {
  return 0.4 * sqrt((sph_material_bulk_modulus(m) + 4 * m->elastic.shear_modulus / 3) / m->density);
}

double sph_material_solid_ratio(const struct sph_material *m) {
  return m->palpha.curve != SPH_CRUSH_NONE && m->palpha.distention > 1 ? m->palpha.distention : 1;
}

double sph_material_bulk_density(const struct sph_material *m) {
  return m->density / sph_material_solid_ratio(m);
}

/* The pressure responds with A, even where K is given. */
double sph_material_longitudinal_speed(const struct sph_material *m, bool strength) {
  const double shear2 = strength ? 4.0 / 3 * m->elastic.shear_modulus / m->density : 0;
  double bulk2 = m->tillotson.A / m->density;
  if (sph_material_solid_ratio(m) > 1 && !isnan(m->palpha.sound_speed))
    bulk2 = m->palpha.sound_speed * m->palpha.sound_speed;
  return sqrt(bulk2 + shear2);
}

/* The largest principal tension, the growth rate of damage and its cap. */

/* Trigonometric solution of the characteristic cubic (Smith 1961, Commun. ACM 4, 168), scaled by the tensor's size. */
double sph_material_largest_tension(double xx, double xy, double xz, double yy, double yz, double zz) {
  double mean = (xx + yy + zz) / 3;
  double a = xx - mean, b = yy - mean, c = zz - mean;
  double p2 = (a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6;
  if (!(p2 > 0))
    return mean;
  double p = sqrt(p2);
  a /= p, b /= p, c /= p, xy /= p, xz /= p, yz /= p;
  double half_det = (a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)) / 2;
  double angle = half_det <= -1 ? M_PI / 3 : half_det >= 1 ? 0 : acos(half_det) / 3;
  return mean + 2 * p * cos(angle);
}

double sph_material_damage_rate(size_t active, int growth) {
  const double n = (double)active;
  return growth == SPH_GROWTH_LINEAR ? n : cbrt(n);
}

double sph_material_damage_cap(size_t active, size_t total, int cap) {
  const double share = (double)active / (double)total;
  return cap == SPH_CAP_BA95    ? cbrt(cbrt(share)) /* D_max = share^(1/3), and the state is its cube root */
         : cap == SPH_CAP_COUNT ? cbrt(share)
                                : 1;
}
