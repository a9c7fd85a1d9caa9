/* The list of papers, and BibTeX from it. Entries without `doi` are papers without a DOI. */
#include "campaign/terminal/references.h"

#include <string.h>

#include "schemas/text.h"

static const struct {
  const char *key, *type, *names; /* names: as sources write them; followed by the year */
  const char *year, *also;        /* also: an abbreviation, or NULL */
  const char *author, *title, *where, *doi;
} papers[] = {
    {"asphaug1993", "article", "Asphaug & Melosh", "1993", NULL, "Asphaug, Erik and Melosh, H. Jay",
     "The Stickney impact of Phobos: a dynamical model", "journal = {Icarus}, volume = {101}, pages = {144--164}",
     NULL},
    {"benz1994", "article", "Benz & Asphaug", "1994", "BA94", "Benz, Willy and Asphaug, Erik",
     "Impact simulations with fracture. I. Method and tests", "journal = {Icarus}, volume = {107}, pages = {98--116}",
     "10.1006/icar.1994.1009"},
    {"benz1995", "article", "Benz & Asphaug", "1995", "BA95", "Benz, Willy and Asphaug, Erik",
     "Simulations of brittle solids using smooth particle hydrodynamics",
     "journal = {Computer Physics Communications}, volume = {87}, pages = {253--265}", "10.1016/0010-4655(94)00176-3"},
    {"benz1999", "article", "Benz & Asphaug", "1999", "BA99", "Benz, Willy and Asphaug, Erik",
     "Catastrophic disruptions revisited", "journal = {Icarus}, volume = {142}, pages = {5--20}",
     "10.1006/icar.1999.6204"},
    {"bonet1999", "article", "Bonet & Lok", "1999", NULL, "Bonet, Javier and Lok, Tat-Seng L.",
     "Variational and momentum preservation aspects of smooth particle hydrodynamic formulations",
     "journal = {Computer Methods in Applied Mechanics and Engineering}, volume = {180}, pages = {97--115}",
     "10.1016/S0045-7825(99)00051-1"},
    {"clauset2009", "article", "Clauset, Shalizi & Newman", "2009", NULL,
     "Clauset, Aaron and Shalizi, Cosma Rohilla and Newman, Mark E. J.", "Power-law distributions in empirical data",
     "journal = {SIAM Review}, volume = {51}, pages = {661--703}", "10.1137/070710111"},
    {"collins2004", "article", "Collins, Melosh & Ivanov", "2004", NULL,
     "Collins, Gareth S. and Melosh, H. Jay and Ivanov, Boris A.",
     "Modeling damage and deformation in impact simulations",
     "journal = {Meteoritics \\& Planetary Science}, volume = {39}, pages = {217--231}",
     "10.1111/j.1945-5100.2004.tb00337.x"},
    {"gray2001", "article", "Gray, Monaghan & Swift", "2001", NULL, "Gray, J. P. and Monaghan, J. J. and Swift, R. P.",
     "SPH elastic dynamics",
     "journal = {Computer Methods in Applied Mechanics and Engineering}, volume = {190}, pages = {6641--6662}",
     "10.1016/S0045-7825(01)00254-7"},
    {"herrmann1969", "article", "Herrmann", "1969", NULL, "Herrmann, Walter",
     "Constitutive equation for the dynamic compaction of ductile porous materials",
     "journal = {Journal of Applied Physics}, volume = {40}, pages = {2490--2499}", "10.1063/1.1658021"},
    {"jutzi2008", "article", "Jutzi, Benz & Michel", "2008", "JBM08",
     "Jutzi, Martin and Benz, Willy and Michel, Patrick",
     "Numerical simulations of impacts involving porous bodies. I. Implementing sub-resolution porosity in a 3D SPH "
     "hydrocode",
     "journal = {Icarus}, volume = {198}, pages = {242--255}", "10.1016/j.icarus.2008.06.013"},
    {"jutzi2009", "article", "Jutzi et al.", "2009", NULL,
     "Jutzi, Martin and Michel, Patrick and Hiraoka, Kensuke and Nakamura, Akiko M. and Benz, Willy",
     "Numerical simulations of impacts involving porous bodies. II. Comparison with laboratory experiments",
     "journal = {Icarus}, volume = {201}, pages = {802--813}", "10.1016/j.icarus.2009.01.018"},
    {"jutzi2015", "article", "Jutzi", "2015", NULL, "Jutzi, Martin",
     "SPH calculations of asteroid disruptions: The role of pressure dependent failure models",
     "journal = {Planetary and Space Science}, volume = {107}, pages = {3--9}", "10.1016/j.pss.2014.09.012"},
    {"kun1999", "article", "Kun", "1999", "K99",
     "Kun, Ferenc and D'Addetta, Gian Antonio and Herrmann, Hans J. and Ramm, Ekkehard",
     "Two-dimensional dynamic simulation of fracture and fragmentation of solids",
     "journal = {Computer Assisted Mechanics and Engineering Sciences}, volume = {6}, pages = {385--402}", NULL},
    {"melosh1989", "book", "Melosh", "1989", NULL, "Melosh, H. Jay", "Impact cratering: a geologic process",
     "publisher = {Oxford University Press}", NULL},
    {"monaghan1992", "article", "Monaghan", "1992", NULL, "Monaghan, J. J.", "Smoothed particle hydrodynamics",
     "journal = {Annual Review of Astronomy and Astrophysics}, volume = {30}, pages = {543--574}",
     "10.1146/annurev.aa.30.090192.002551"},
    {"monaghan2000", "article", "Monaghan", "2000", NULL, "Monaghan, J. J.", "SPH without a tensile instability",
     "journal = {Journal of Computational Physics}, volume = {159}, pages = {290--311}", "10.1006/jcph.2000.6439"},
    {"nakamura2007", "article", "Nakamura, Michel & Setoh", "2007", NULL,
     "Nakamura, Akiko M. and Michel, Patrick and Setoh, Masato",
     "Weibull parameters of Yakuno basalt targets used in documented high-velocity impact experiments",
     "journal = {Journal of Geophysical Research}, volume = {112}, pages = {E02001}", "10.1029/2006JE002757"},
    {"randles1996", "article", "Randles & Libersky", "1996", NULL, "Randles, P. W. and Libersky, L. D.",
     "Smoothed particle hydrodynamics: some recent improvements and applications",
     "journal = {Computer Methods in Applied Mechanics and Engineering}, volume = {139}, pages = {375--408}",
     "10.1016/S0045-7825(96)01090-0"},
    {"tillotson1962", "techreport", "Tillotson", "1962", NULL, "Tillotson, J. H.",
     "Metallic equations of state for hypervelocity impact", "institution = {General Atomic}, number = {GA-3216}",
     NULL},
};

size_t references_count(void) {
  return sizeof papers / sizeof papers[0];
}

/* True when the names at `at` in the source are part of a longer list of names: "Monaghan" is not "Gray, Monaghan &
 * Swift". */
static bool is_longer(const char *source, const char *at, size_t length) {
  const char *behind = at + length;
  const bool ends = at >= source + 2 && (strncmp(at - 2, ", ", 2) == 0 || strncmp(at - 2, "& ", 2) == 0);
  return ends || ((behind[0] == ',' || behind[0] == ' ') && behind[1] == '&');
}

/* True when the year follows the names, perhaps after other years: "Benz & Asphaug (1994, 1995)". */
static bool year_follows(const char *rest, const char *year) {
  static const char more_names[] = ", D'Addetta, Herrmann & Ramm";
  if (strncmp(rest, more_names, sizeof more_names - 1) == 0)
    rest += sizeof more_names - 1;
  const char *found = strstr(rest, year);
  return found && (size_t)(found - rest) < strspn(rest, " (),0123456789");
}

bool references_named(size_t index, const char *source) {
  const char *names = papers[index].names;
  const size_t length = strlen(names);
  if (papers[index].also && strstr(source, papers[index].also))
    return true;
  for (const char *at = strstr(source, names); at; at = strstr(at + 1, names))
    if (!is_longer(source, at, length) && year_follows(at + length, papers[index].year))
      return true;
  return false;
}

void references_doi(const char *source, char *text, size_t size) {
  text[0] = '\0';
  for (size_t i = 0; i < references_count(); i++)
    if (papers[i].doi && references_named(i, source))
      text_append(text, size, "%s%s", *text ? " " : "", papers[i].doi);
}

void references_bibtex(size_t index, FILE *out) {
  fprintf(out, "@%s{%s,\n  author = {%s},\n  title = {{%s}},\n  %s,\n  year = {%s}", papers[index].type,
          papers[index].key, papers[index].author, papers[index].title, papers[index].where, papers[index].year);
  if (papers[index].doi)
    fprintf(out, ",\n  doi = {%s}", papers[index].doi);
  fputs("\n}\n", out);
}
