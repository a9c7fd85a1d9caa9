/* Fuzz target: any bytes as the document of measurements (`clast fit MEASURED.yaml ...`). An accepted document has
 * known quantities, finite numbers, and shots that can be run. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/document/observed.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

/* As in fuzz_document.c: a refused document leaks 1 kB inside libfyaml 0.7.12. */
__attribute__((visibility("default"))) const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
  return "leak:libfyaml\n";
}

static void must(bool truth) {
  if (!truth)
    abort();
}

static struct campaign *campaign_of_discs(void) {
  static const char text[] = "name: t\nscene: disc-explosion\nvary: {strain: {uniform: [1 %, 8 %]}}\n"
                             "design: {kind: random, points: 20}\n";
  struct campaign *campaign = NULL;
  struct error error;
  must(campaign_parse("c.yaml", text, strlen(text), NULL, &campaign, &error) == STATUS_OK);
  return campaign;
}

static void judge_datum(const struct observed *m, size_t k) {
  const struct observed_datum *datum = &m->data[k];
  const bool above = datum->ask.kind == ASK_SPECIMENS_COUNT || datum->ask.kind == ASK_SPECIMENS_SHARE;
  char label[2 * FIELD_TEXT_SIZE];
  must(datum->shot < m->shot_count && isfinite(datum->value));
  must(isfinite(datum->error) && datum->error >= 0 && (isnan(datum->resolution) || datum->resolution >= 0));
  must(!above || (datum->share > 0 && datum->share < 1));
  must(above || datum->ask.kind == ASK_SPECIMENS_EXPONENT || datum->ask.row);
  observed_label(m, k, label, sizeof label);
  must(label[0]);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size) {
  static struct campaign *campaign;
  struct observed *observed;
  struct error error;
  if (!campaign)
    campaign = campaign_of_discs();
  error.message[0] = 0;
  const status code = observed_parse("m.yaml", (const char *)bytes, size, campaign, &observed, &error);
  if (code) {
    must(code == STATUS_CONTENT && !observed && error.message[0]);
    return 0;
  }
  must(observed->shot_count > 0 && observed->shot_count <= OBSERVED_SHOTS);
  must(observed->datum_count > 0 && observed->datum_count <= OBSERVED_DATA);
  for (size_t s = 0; s < observed->shot_count; s++)
    must(observed->shots[s].specimens >= 1 && observed->shots[s].scene);
  for (size_t k = 0; k < observed->datum_count; k++)
    judge_datum(observed, k);
  observed_free(observed);
  return 0;
}
