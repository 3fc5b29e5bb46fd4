"""One thread for each worker, or they stand in each other's way."""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
