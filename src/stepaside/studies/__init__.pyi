from .study import Study as Study
from .study import StudyRun as StudyRun
from .study import merge_results as merge_results
from .study import run_study as run_study
from .study_design import load_study as load_study
from .study_design import make_study as make_study
from .tabulation import tabulate as tabulate
from .tabulation import to_frame as to_frame

__all__ = [
    "Study",
    "StudyRun",
    "load_study",
    "make_study",
    "merge_results",
    "run_study",
    "tabulate",
    "to_frame",
]
