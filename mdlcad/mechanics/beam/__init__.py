"""The parts' reduced models held against a geometrically nonlinear beam computation of the same geometry."""
