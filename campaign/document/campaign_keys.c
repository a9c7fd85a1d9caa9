/* What the keys of a campaign with several forms mean. campaign_read.c and campaign_vary.c read them. */
#include "campaign/document/campaign_keys.h"

#include <string.h>

#include "campaign/document/campaign.h"
#include "schemas/text.h"

const struct campaign_key campaign_keys[] = {
    {.name = "vary",
     .words = "from to n log uniform log_uniform normal mean sd truncated lognormal median sigma linked factor offset "
              "values",
     .doc = "Inputs of the scene that vary: the path of each, or a unique ending of it, and its values.",
     .forms = "    [1 %, 3 %, 6 %]                                    these values\n"
              "    {from: 1 %, to: 6 %, n: 6}                         even steps, both ends included\n"
              "    {log: [1 %, 6 %], n: 6}                            even steps of the logarithm\n"
              "    {uniform: [1 %, 6 %]}                              a law: uniform between two values\n"
              "    {log_uniform: [1 %, 6 %]}                          uniform in the logarithm\n"
              "    {normal: {mean: 4 deg, sd: 1 deg}}                 may be cut: truncated: [1 deg, 7 deg]\n"
              "    {lognormal: {median: 1 GPa, sigma: 0.05}}          sigma of the natural logarithm; truncated, too\n"
              "    {linked: threshold.strain, factor: 2}               factor (default 1) times another varied input,\n"
              "                                                       plus offset (SI, default 0)\n"
              "    {linked: threshold.strain, values: [2 deg, 6 deg]} i-th value with the i-th one of that input\n"
              "    Laws need a sampling design: clast explain design\n"},
    {.name = "set",
     .words = "",
     .doc = "Inputs of the scene with another value for the whole campaign.",
     .forms = "    {contact.friction: 0.2, body.diameter: 8 cm}       path of each, or a unique ending of it\n"},
    {.name = "design",
     .words = "grid list random latin_hypercube sobol kind points seed file",
     .doc = "How points are made from the varied inputs. Default: grid.",
     .forms =
         "    grid, or list                                      of values that are given\n"
         "    {kind: sobol, points: 64, seed: 1}                 of laws; or kind random, latin_hypercube\n"
         "    {file: points.csv}                                 from another program: a header of input paths, a\n"
         "                                                       line for each point. A column \"threshold.angle\n"
         "                                                       [deg]\" is in degrees, \"[1]\" in fractions\n",
     .table = &campaign_design_table},
    {.name = "keep",
     .words = "fields none all extremes first",
     .doc = "Runs that keep their fields as HDF5 files. Default: none.",
     .forms = "    {fields: none}, {fields: all}\n"
              "    {fields: first 3}                                  the first replicates of each point\n"
              "    {fields: extremes}                                 of each point the runs with the least and the\n"
              "                                                       greatest main quantity (key quantity)\n"},
};
const size_t campaign_keys_count = sizeof campaign_keys / sizeof campaign_keys[0];

const struct campaign_key *campaign_keys_find(const char *path) {
  const size_t head = strcspn(path, ".");
  for (size_t i = 0; i < campaign_keys_count; i++) {
    const struct campaign_key *key = &campaign_keys[i];
    const bool named = strlen(key->name) == head && strncmp(key->name, path, head) == 0;
    if (named && (path[head] == '\0' || text_has_word(key->words, path + head + 1)))
      return key;
    if (!named && text_has_word(key->words, path))
      return key;
  }
  return NULL;
}
