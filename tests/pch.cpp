// The file that the precompiled header (pch.hpp) is compiled with.
