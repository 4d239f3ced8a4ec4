//! A window that moves with a shock: feed, inlet, outlet, frame, ledger and the search for the shock velocity
