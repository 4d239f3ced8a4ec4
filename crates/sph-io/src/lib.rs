//! What leaves and enters the process: tables, plots, field images, ParaView snapshots, checkpoints, progress
