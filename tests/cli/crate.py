"""crate.py FOLDER: does the folder meet every MUST of RO-Crate 1.1 (sections Metadata Document, Root Data Entity, Data
Entities) and of the profile Process Run Crate 0.5? Then the same document with one fault at a time must not."""
import copy
import datetime
import json
import os
import sys
import urllib.parse

CRATE, PROFILE = "https://w3id.org/ro/crate/1.1", "https://w3id.org/ro/wfrun/process/0.5"
TOOLS = {"SoftwareApplication", "SoftwareSourceCode", "ComputationalWorkflow"}
ACTIONS = {"CreateAction", "ActivateAction", "UpdateAction"}


def listed(value):
    return value if isinstance(value, list) else [] if value is None else [value]


def kinds(entity):
    return set(listed(entity.get("@type")))


def faults(document, folder):
    """What is wrong, in words; nothing when all is well."""
    contexts = listed(document.get("@context"))
    if f"{CRATE}/context" not in contexts:
        yield "the context of RO-Crate 1.1 is missing"
    graph = document.get("@graph")
    if not isinstance(graph, list):
        yield "@graph is no list"
        return
    entities = {}
    for entity in graph:
        if not entity.get("@id") or not kinds(entity):
            yield f"no @id or @type: {entity}"
        elif entity["@id"] in entities:
            yield f"twice: {entity['@id']}"
        entities[entity.get("@id")] = entity
        for name, values in entity.items():  # flat: references have nothing but @id
            for value in listed(values):
                if isinstance(value, dict) and list(value) != ["@id"]:
                    yield f"{entity['@id']}.{name} is nested"

    descriptor = entities.get("ro-crate-metadata.json", {})
    if "CreativeWork" not in kinds(descriptor):
        yield "the descriptor is no CreativeWork"
    if {"@id": CRATE} not in listed(descriptor.get("conformsTo")):
        yield "the descriptor does not conform to RO-Crate 1.1"
    root = entities.get(descriptor.get("about", {}).get("@id"), {})
    if "Dataset" not in kinds(root) or not root.get("@id", "").endswith("/"):
        yield "the root is no Dataset"
    for name in ("name", "description", "datePublished", "license"):
        if not root.get(name):
            yield f"the root has no {name}"
    try:
        datetime.datetime.fromisoformat(root.get("datePublished", "").replace("Z", "+00:00"))
    except ValueError:
        yield "datePublished is no date of ISO 8601"

    parts = {part["@id"] for part in listed(root.get("hasPart"))}
    for name, entity in entities.items():
        if "File" in kinds(entity) and not os.path.isfile(os.path.join(folder, urllib.parse.unquote(name))):
            yield f"{name}: there is no such file"
        if "File" in kinds(entity) and name not in parts:
            yield f"{name} is no part of the root"
    for name in parts - set(entities):
        yield f"the part {name} is not described"
    for entity in graph:  # our own rule: what is referred to within the crate is described
        for values in entity.values():
            for value in listed(values):
                if isinstance(value, dict) and "://" not in value["@id"] and value["@id"] not in entities:
                    yield f"{entity['@id']} refers to {value['@id']}, which is not described"

    profiles = [entities.get(value["@id"], {}) for value in listed(root.get("conformsTo")) if value["@id"] == PROFILE]
    if not profiles or "CreativeWork" not in kinds(profiles[0]):
        yield "the root does not conform to the profile as a CreativeWork"
    actions = [entity for entity in graph if kinds(entity) & ACTIONS]
    if not actions:
        yield "no action"
    mentioned = {value["@id"] for value in listed(root.get("mentions"))}
    for action in actions:
        tools = listed(action.get("instrument"))
        if not tools or not all(kinds(entities.get(tool["@id"], {})) & TOOLS for tool in tools):
            yield f"{action['@id']} has no tool as its instrument"
        if action["@id"] not in mentioned:  # SHOULD
            yield f"{action['@id']} is not mentioned by the root"
        for name in ("startTime", "endTime"):
            if name in action:
                datetime.datetime.fromisoformat(action[name].replace("Z", "+00:00"))


folder = sys.argv[1]
document = json.load(open(os.path.join(folder, "ro-crate-metadata.json"), encoding="utf-8"))
found = list(faults(document, folder))
assert not found, found
files = {entity["@id"] for entity in document["@graph"] if "File" in kinds(entity)}
assert files | {"ro-crate-metadata.json"} == set(os.listdir(folder)), "a file of the folder is not described"

graph = document["@graph"]
places = {entity["@id"]: i for i, entity in enumerate(graph)}
tool = next(entity["@id"] for entity in graph if kinds(entity) & TOOLS)
planted = {
    "no context": lambda d: d.update({"@context": []}),
    "no instrument": lambda d: d["@graph"][places["#session-1"]].pop("instrument"),
    "no tool": lambda d: d["@graph"].pop(places[tool]),
    "no date": lambda d: d["@graph"][places["./"]].update(datePublished="yesterday"),
    "no licence": lambda d: d["@graph"][places["./"]].pop("license"),
    "no profile": lambda d: d["@graph"][places["./"]].pop("conformsTo"),
    "no file": lambda d: d["@graph"][places["runs.csv"]].update({"@id": "lost.csv"}),
    "no part": lambda d: d["@graph"][places["./"]]["hasPart"].pop(),
    "nested": lambda d: d["@graph"][places["./"]].update(author={"@id": "#a", "name": "x"}),
    "twice": lambda d: d["@graph"].append(d["@graph"][2]),
}
for name, plant in planted.items():
    wrong = copy.deepcopy(document)
    plant(wrong)
    assert list(faults(wrong, folder)), f"the fault \"{name}\" was not found"
print(len(graph), "entities,", len(planted), "planted faults found")
