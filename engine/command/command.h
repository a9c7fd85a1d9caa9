/* The engine `command`: other people's programs. engine/command/README.md says how a scene names one. */
#pragma once

#include "engine/engine.h"

extern const struct engine_kind command_engine;
