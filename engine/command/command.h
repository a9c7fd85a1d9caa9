/* The engine `command`: other people's programs. engine/command/README.md says how a scene names one. */
#ifndef CLAST_ENGINE_COMMAND_COMMAND_H
#define CLAST_ENGINE_COMMAND_COMMAND_H

#include "engine/engine.h"

extern const struct engine_kind command_engine;

#endif
