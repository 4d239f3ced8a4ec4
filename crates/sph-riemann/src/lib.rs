//! Godunov-type smoothed particle hydrodynamics for elastic-plastic solids: contact, reconstruction, rates, one step
