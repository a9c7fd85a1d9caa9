#include "campaign/campaign_schema.h"

#include "campaign/campaign.h"
#include "schemas/json_schema.h"

/* A value as a document writes it; which unit and range suit, the input's own row says when the document is read. */
#define VALUE  "{\"type\": [\"number\", \"string\", \"boolean\"]}"
#define NUMBER "{\"type\": [\"number\", \"string\"]}"
#define PAIR   "{\"type\": \"array\", \"minItems\": 2, \"maxItems\": 2, \"items\": " NUMBER "}"
#define LIST   "{\"type\": \"array\", \"minItems\": 1, \"items\": " VALUE "}"
#define COUNT  "{\"type\": \"integer\", \"minimum\": 2, \"maximum\": 1000000}"
#define FORM(doc, required, properties)                                                                                \
  "{\"type\": \"object\", \"description\": \"" doc "\", \"required\": [" required                                      \
  "], \"additionalProperties\": false,\n           \"properties\": {" properties "}}"

static const char
    vary[] =
        "    \"vary\": {\n"
        "      \"type\": \"object\",\n"
        "      \"description\": \"Inputs of the scene that are varied: path (or unique end of one) and its values.\",\n"
        "      \"additionalProperties\": {\"anyOf\": [\n"
        "          " LIST ",\n"
        "          " FORM(
            "n evenly spaced values, ends included", "\"from\", \"to\", \"n\"",
            "\"from\": " NUMBER ", \"to\": " NUMBER
            ", \"n\": " COUNT) ",\n"
                               "          " FORM(
                                   "n logarithmically spaced values, ends included", "\"log\", \"n\"",
                                   "\"log\": " PAIR
                                   ", \"n\": " COUNT) ",\n"
                                                      "          " FORM(
                                                          "uniform law", "\"uniform\"",
                                                          "\"uniform\": " PAIR) ",\n"
                                                                                "          " FORM(
                                                                                    "uniform law of the logarithm",
                                                                                    "\"log_uniform\"",
                                                                                    "\"log_uniform\": " PAIR) ",\n"
                                                                                                              "        "
                                                                                                              "  " FORM(
                                                                                                                  "norm"
                                                                                                                  "al "
                                                                                                                  "law,"
                                                                                                                  " cut"
                                                                                                                  " at "
                                                                                                                  "the "
                                                                                                                  "two "
                                                                                                                  "valu"
                                                                                                                  "es "
                                                                                                                  "of "
                                                                                                                  "trun"
                                                                                                                  "cate"
                                                                                                                  "d",
                                                                                                                  "\"no"
                                                                                                                  "rmal"
                                                                                                                  "\"",
                                                                                                                  "\"no"
                                                                                                                  "rmal"
                                                                                                                  "\":"
                                                                                                                  " " FORM(
                                                                                                                      "",
                                                                                                                      "\"mean\", \"sd\"",
                                                                                                                      "\"mean\": " NUMBER
                                                                                                                      ", \"sd\": " NUMBER) ", \"truncated\": " PAIR) ",\n"
                                                                                                                                                                     "          " FORM(
                                                                                                                                                                         "lognormal law; sigma is the standard deviation of the natural logarithm",
                                                                                                                                                                         "\"lognormal\"",
                                                                                                                                                                         "\"lognormal\": " FORM(
                                                                                                                                                                             "", "\"median\", \"sigma\"", "\"median\": " NUMBER ", \"sigma\": " NUMBER) ", \"truncated\": " PAIR) ",\n"
                                                                                                                                                                                                                                                                                  "          " FORM("factor times the value of another varied input, plus offset (SI)", "\"linked\"", "\"linked\": {\"type\": \"string\"}, \"factor\": " NUMBER ", \"offset\": " NUMBER) ",\n"
                                                                                                                                                                                                                                                                                                                                                                                                                                                                         "          " FORM("the i-th value goes with the i-th value of another varied input",
                                                                                                                                                                                                                                                                                                                                                                                                                                                                                           "\"linked\", \"values\"",
                                                                                                                                                                                                                                                                                                                                                                                                                                                                                           "\"linked\": {\"type\": \"string\"}, \"values\": " LIST) "\n"
                                                                                                                                                                                                                                                                                                                                                                                                                                                                                                                                                    "      ]}\n"
                                                                                                                                                                                                                                                                                                                                                                                                                                                                                                                                                    "    },\n";

static const char set[] = "    \"set\": {\n"
                          "      \"type\": \"object\",\n"
                          "      \"description\": \"Inputs of the scene set to one value for the whole campaign.\",\n"
                          "      \"additionalProperties\": " VALUE "\n"
                          "    },\n";

static const char keep[] =
    "    \"keep\": {\n"
    "      \"type\": \"object\", \"additionalProperties\": false, \"required\": [\"fields\"],\n"
    "      \"properties\": {\"fields\": {\n"
    "        \"description\": \"Which runs keep their fields (grains, beams, breaks; particles) as HDF5 files: none, "
    "all, the two runs of a "
    "point with the least and the greatest main quantity, or the first N replicates of a point.\",\n"
    "        \"anyOf\": [{\"enum\": [\"none\", \"all\", \"extremes\"]}, {\"type\": \"string\", \"pattern\": \"^first "
    "[1-9][0-9]{0,8}$(?!\\\\n)\"}]\n"
    "      }}\n"
    "    },\n";

/* A fixed number of seeds and a rule exclude each other; only the rule has a maximum, and it needs a width. */
static const char seeds[] = "    {\"properties\": {\"seeds\": {\n"
                            "      \"not\": {\"required\": [\"per_point\", \"until\"]},\n"
                            "      \"if\": {\"required\": [\"max\"]}, \"then\": {\"required\": [\"until\"]},\n"
                            "      \"properties\": {\"until\": {\"required\": [\"half_width\"]}}\n"
                            "    }}}\n";

void campaign_schema_write(FILE *out) {
  fputs("{\n  \"$schema\": \"http://json-schema.org/draft-07/schema#\",\n  \"title\": \"clast campaign\",\n"
        "  \"description\": \"Many runs of one scene: what is varied, how often, within which limits.\",\n"
        "  \"type\": \"object\",\n  \"additionalProperties\": false,\n  \"required\": [",
        out);
  json_schema_required(&campaign_table, out);
  fputs("],\n  \"properties\": {\n", out);
  fputs(vary, out);
  fputs(set, out);
  fputs("    \"design\": {\"anyOf\": [\n"
        "      {\"enum\": [\"grid\", \"list\"]},\n"
        "      {\"type\": \"object\", \"additionalProperties\": false,\n"
        "       \"if\": {\"required\": [\"kind\"], \"properties\": {\"kind\": {\"enum\": [\"random\", "
        "\"latin_hypercube\", "
        "\"sobol\"]}}},\n"
        "       \"then\": {\"required\": [\"points\"]},\n"
        "       \"else\": {\"not\": {\"anyOf\": [{\"required\": [\"points\"]}, {\"required\": [\"seed\"]}]}},\n"
        "       \"properties\": {",
        out);
  json_schema_properties(&campaign_design_table, 4, out);
  fputs("}}\n    ]},\n", out);
  fputs(keep, out);
  fputs("    ", out);
  json_schema_properties(&campaign_table, 2, out);
  fputs("\n  },\n  \"allOf\": [\n", out);
  fputs(seeds, out);
  fputs("  ]\n}\n", out);
}
