/* Facts about this program and machine, kept with every session of a store: version, commit (with its dirty flag),
 * compiler, flags, libraries, cpu model and class (bits are promised for one binary on one class), host, ranks, slots,
 * command line. Provenance, not identity. */
#ifndef CLAST_CAMPAIGN_SCHEDULER_PROVENANCE_H
#define CLAST_CAMPAIGN_SCHEDULER_PROVENANCE_H

/* A JSON object, malloc'd; NULL when memory is out. argv may be NULL. */
char *provenance_json(int ranks, int slots, int argc, char *const *argv);

/* Names the build that computed a session, from the session's facts: "clast 0.9, commit abc, gcc 12". Writes "" for
 * this build, or when the facts are empty or do not name a build. */
enum { PROVENANCE_BUILD_SIZE = 320 };
void provenance_other_build(const char *version, const char *commit, const char *compiler,
                            char text[PROVENANCE_BUILD_SIZE]);

#endif
