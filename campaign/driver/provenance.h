/* Facts about this program and machine, kept with every session of a store: version, commit (with its dirty flag),
 * compiler, flags, libraries, cpu model and class (bits are promised for one binary on one class), host, ranks, slots,
 * command line. Provenance, not identity. */
#ifndef CLAST_CAMPAIGN_DRIVER_PROVENANCE_H
#define CLAST_CAMPAIGN_DRIVER_PROVENANCE_H

/* A JSON object, malloc'd; NULL when memory is out. argv may be NULL. */
char *provenance_json(int ranks, int slots, int argc, char *const *argv);

/* Names a program that is another build than this one, with the facts of a session: "clast 0.9, commit abc, gcc 12".
 * Writes "" when it is this build, or when the facts ("") do not tell. */
enum { PROVENANCE_BUILD_SIZE = 320 };
void provenance_other_build(const char *version, const char *commit, const char *compiler,
                            char text[PROVENANCE_BUILD_SIZE]);

#endif
